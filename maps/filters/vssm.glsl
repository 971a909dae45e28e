// SPDX-License-Identifier: Apache-2.0
#include "maps/filters/vssm.shared.h"
#define OWN_PUSH VssmPush
#include "maps/host/look_up.glsl"
#define PREFILTER_FIRST (FIRST_PRODUCT + 2)
#include "maps/products/prefilter.glsl"

layout(constant_id = 2) const uint kModel = kVariance;
layout(constant_id = 3) const uint kCuts = 0;  // largest number of times a window is cut in four; only for models with
                                               // bounds
layout(constant_id = 4) const uint kSubdivision = kUniform;
layout(constant_id = 5) const uint kWindowTexels = 0;  // width of a fixed filter in texels; 0: the light's size
                                                       // determines the window
layout(constant_id = 6) const float kOffset = 1.0;     // csm: shift of the step, in lobes
layout(constant_id = 7) const float kDamping = 0.0;    // csm: rate at which the coefficients fall off
layout(constant_id = 8) const uint kSmoothLeak = 0;    // 1: values above `leak` are stretched smoothly
layout(constant_id = 9) const uint kFarthest = 0;      // esm, 1: texel by texel wherever a texel may be behind the
                                                       // receiver
layout(constant_id = 10) const uint kImageCuts = 0;    // with FITTED_FACES: largest number of times a window is cut in
                                                       // four because its image is no box

layout(scalar, binding = FIRST_PRODUCT) readonly buffer Nearest { float nearest[2]; };
layout(scalar, binding = FIRST_PRODUCT + 1) readonly buffer Frame { MapFrame frame; };
layout(scalar, binding = FIRST_PRODUCT + 7) readonly buffer Pattern { vec2 pattern[]; };  // light points in the light's basis
#include "maps/filters/horizon.glsl"

#define PYRAMID_BINDING (FIRST_PRODUCT + 8)
#include "maps/products/depth_pyramid.glsl"

// Soft shadows with the windows of pcss (pcss.comp), from statistics of whole windows in place of taps. Heights are t
// in [0, 1], see prefilter_value.glsl; "lit" is the fraction of a window's texels that are not nearer than the
// receiver.
//
// Where the mean of a window is not nearer than the receiver, Chebyshev's bound is 1 and gives no information, though
// the window may hold blockers: its contents are not one plane. So windows are cut into parts (Yang et al. 2010, kernel
// subdivision): parts whose mean is nearer use their bound, the others are compared at some of their texels, and the
// results are added.

const float kLog2E = 1.4426950408889634;
// Means are right to about 2^-23 (24 binary digits, sums of float32): a smaller variance is rounding.
const float kLeastVariance = 1.0 / 4194304.0;

// Rounding of esm: a height is off by a few 2^-24 of its range, its exponential by up to 80 times this error.
const float kHeightRounding = 1.0 / 1048576.0, kBeyondRounding = 1.0 / 1024.0;

// Returns Chebyshev's bound (Donnelly and Lauritzen 2006): the largest possible fraction of a distribution at x or
// beyond.
float chebyshev(float mean, float variance, float x) {
  return x <= mean ? 1.0 : variance / (variance + (x - mean) * (x - mean));
}

// Returns the power of two by which the mean of function i is multiplied. Exponentials are evaluated relative to the
// receiver's own, exp(c (t_q - t)) and exp(-c (t_q - t)): then the receiver's is 1.
float log2_scale(uint i, float t) {
  const float up = own.exponent * (1.0 - t) * kLog2E, down = own.exponent * t * kLog2E;
  if (kModel == kExponential) return i == 0 ? up : 0.0;
  if (kModel != kExpVariance || i == 4) return 0.0;
  return (i < 2 ? up : down) * (i % 2 == 0 ? 1.0 : 2.0);
}

// Returns the height stored in a texel.
float height_of_texel(LightView view, uint face, uvec2 at, uint s) {
  const float depth = maps[(face * table.size + at.y) * table.size + at.x];
#ifdef FITTED_FACES
  const float height = face_height(fitted_faces[face], (vec2(at) + 0.5) / float(table.size));
#else
  const bool sideways = face != view.side[s].first_face;
  const float height = sideways ? (float(at.y) + 0.5) / float(table.size) : 1.0;
#endif
  return depth < 1.0 ? normalised_height(depth * view.far * height, nearest[s], frame.deepest[s]) : 1.0;
}

// Returns the mean of the exponential, limited to 1 texel by texel (Annen, Mertens et al. 2008, section 3.4); for a
// large box, at some of its texels.
const uint kFallbackTaps = 16;  // along an axis
float lit_texel_by_texel(LightView view, Box box, float t, uint s) {
  if (!(box.inside > 0.0)) return 1.0;  // outside the map there is no caster
  const vec2 first = floor(box.lower), extent = ceil(box.upper) - first;
  const uvec2 count = uvec2(min(extent, vec2(kFallbackTaps)));
  float sum = 0.0;
  for (uint j = 0; j < count.y; ++j) {
    for (uint i = 0; i < count.x; ++i) {
      const uvec2 at = uvec2(first + (vec2(i, j) + 0.5) * extent / vec2(count));
      const float q = height_of_texel(view, box.face, at, s);
      sum += min(exp(own.exponent * (q - t)), 1.0);
    }
  }
  return box.inside * sum / float(count.x * count.y) + (1.0 - box.inside);
}

// Receiver, for all windows of a pixel.
struct Asking {
  vec3 d, m;
  uint s;       // side of the light's plane
  float t;      // height, less the bias
  float kept;   // fraction of a height left by the bias
  float slack;  // kExpVariance: the height subtracted by the bias; kExponential: the change of t for rounding
};

float normalised(Asking asking, float height) {
  return normalised_height(height, nearest[asking.s], frame.deepest[asking.s]);
}

// Returns the height of the receiver's plane at a position on a face, in texels, less the bias; no deeper than the
// receiver, as in blocks_light(). receiverPlane=off: the receiver's own height.
float plane_height(LightView view, Asking asking, uint face, vec2 place) {
  const float h = dot(asking.m, asking.d);
  if (lookup.own_depth != 0 || !(h > 0.0)) return asking.t;
#ifdef FITTED_FACES
  vec3 direction = face_direction(fitted_faces[face], place / float(table.size));
#else
  const SideView side = view.side[asking.s];
  const MapFace on = face_of(side, 0, table.size, face - side.first_face);
  vec3 direction = from_face(on, vec3(on.lower + place * on.texel, 1.0));
#endif
  if (asking.s == 1) direction.z = -direction.z;
  const float facing = dot(asking.m, direction), across = abs(direction.z), own_height = abs(asking.d.z);
  return h * across < own_height * facing ? normalised(asking, asking.kept * h / facing * across) : asking.t;
}

// Evaluates a part of a window without a valid bound at some of its texels. Returns the fraction not nearer than the
// receiver's plane; `blocked` is the sum of the other texels' heights, divided by the number of all texels.
const uint kPartTaps = 4;  // along an axis
float lit_at_texels(LightView view, Asking asking, Box box, out float blocked) {
  blocked = 0.0;
  if (!(box.inside > 0.0)) return 1.0;
  const vec2 extent = box.upper - box.lower;
  const uvec2 count = uvec2(clamp(ceil(extent), vec2(1.0), vec2(kPartTaps)));
  float lit = 0.0;
  for (uint k = 0; k < count.x * count.y; ++k) {
    const vec2 place = box.lower + (vec2(k % count.x, k / count.x) + 0.5) * extent / vec2(count);
    const uvec2 at = min(uvec2(place), uvec2(table.size - 1));
    const float q = height_of_texel(view, box.face, at, asking.s);
    if (q < plane_height(view, asking, box.face, vec2(at) + 0.5)) {
      blocked += q;
    } else {
      lit += 1.0;
    }
  }
  const float share = box.inside / float(count.x * count.y);
  blocked *= share;
  return lit * share + (1.0 - box.inside);
}

// Returns the least and the greatest height possible in a box, from the pyramid. On a sideways face, a height is the
// depth times the distance of the texel's row from the light's plane.
vec2 heights_within(LightView view, Box box, uint s) {
  if (!(box.inside > 0.0)) return vec2(1.0);
  const uvec2 first = uvec2(box.lower), last = max(uvec2(ceil(box.upper)), first + 1) - 1;
  const vec2 depths = depth_range(box.face, first, last) * view.far;
#ifdef FITTED_FACES
  // On a homography's face, the factor of a row's depths is a quotient of linear functions: within a box, it is between
  // the factors at the corners.
  vec2 rows = vec2(1.0, 0.0);
  for (uint k = 0; k < 4; ++k) {
    const vec2 corner = vec2((k & 1) == 0 ? first.x : last.x, (k & 2) == 0 ? first.y : last.y);
    const float height = face_height(fitted_faces[box.face], (corner + 0.5) / float(table.size));
    rows = vec2(min(rows.x, height), max(rows.y, height));
  }
#else
  const bool sideways = box.face != view.side[s].first_face;
  const vec2 rows = sideways ? (vec2(first.y, last.y) + 0.5) / float(table.size) : vec2(1.0);
#endif
  return vec2(normalised_height(depths.x * rows.x, nearest[s], frame.deepest[s]),
              normalised_height(depths.y * rows.y, nearest[s], frame.deepest[s]));
}

// Returns the lit fraction of the window; if `search`, `blocked` is the sum of the heights, in t, of the texels that
// are not lit, divided by the number of all texels.
float lit_share(LightView view, Asking asking, Box box, float t, bool search, out float blocked) {
  // Lauritzen and McCool 2008: the layer that contains t has no information about heights outside the layer. With one
  // layer, its mean is the mean of t.
  const float layers = float(own.count);
  const uint layer = kModel == kVariance ? min(uint(t * layers), own.count - 1) : 0;
  const uint of_lit = kModel == kVariance ? 2 : kModel == kExpVariance ? 4 : kModel == kFourier ? 2 * own.count : 1;
  const uint of_heights = kModel == kVariance && own.count == 1 ? 0 : kModel == kFourier ? 2 * own.count + 1 : 1;
  const uint count = of_lit + (search ? of_heights : 0);

  float mean[5] = float[](0.0, 0.0, 0.0, 0.0, 0.0);
  float lit = 0.5, blockers = 0.0;  // kFourier
  for (uint k = 0; k < count; ++k) {
    const uint i = kModel == kFourier && !search ? k / 2 * 4 + k % 2 : k;
    uint function = i;
    if (kModel == kVariance) function = i < 2 ? 2 * layer + i : 2 * own.count;  // the last function is t
    const float found = mean_over(function, box, log2_scale(i, t));
    if (kModel != kFourier) {
      mean[i] = found;
    } else if (i == 4 * own.count) {
      blockers += 0.5 * found;
    } else {
      // Annen et al. 2007 (Eisemann et al. 2009, equation 4.6): lit = 1/2 + 2 sum of sin(c_k (t_q - t)) / c_k, with
      // heights that span less than half the period, and the sum of (1 - lit) t_q by the same series (Annen et al.
      // 2008). Stored are sin, cos, t sin and t cos. The step is shifted by `kOffset` lobes, so that points level with
      // the receiver are lit, and its coefficients fall off (Eisemann et al. 2009, figure 4.8).
      const float number = float(i / 4) + 1.0, c = (2.0 * number - 1.0) * 3.14159265358979;
      const float span = fourier_span(own.count, kOffset);
      const float at = c * (span * t - 0.5 * kOffset / float(own.count));
      const float damped = exp(-kDamping * (number / float(own.count)) * (number / float(own.count)));
      const float term = damped * (2.0 / c * (2.0 * found - 1.0) * (i % 2 == 0 ? cos(at) : -sin(at)));
      if (i % 4 < 2) {
        lit += term;
      } else {
        blockers -= term;
      }
    }
  }

  float height = 0.0;  // mean of t
  if (kModel == kFourier) {
    blocked = blockers;
    return lit;
  } else if (kModel == kVariance) {
    const float off = mean[0] - 0.5, variance = mean[1] - off * off;
    lit = chebyshev(mean[0], max(variance, kLeastVariance * layers * layers), t * layers - float(layer));
    height = own.count == 1 ? mean[0] : mean[2];
  } else if (kModel == kExpVariance) {
    const float least = max(kLeastVariance, asking.slack * asking.slack) * own.exponent * own.exponent;
    lit = min(chebyshev(mean[0], max(mean[1] - mean[0] * mean[0], least), 1.0),
              chebyshev(-mean[2], max(mean[3] - mean[2] * mean[2], least), -1.0));
    height = mean[4];
  } else {
    lit = mean[0];
    if (kFarthest != 0 ? heights_within(view, box, asking.s).y > t + kBeyondRounding : lit > 1.0 + kBeyondRounding) {
      lit = own.fallback != 0 ? lit_texel_by_texel(view, box, t, asking.s) : 1.0;
    }
    lit = min(lit, 1.0);
    height = mean[1];
  }
  // Yang et al. 2010: lit texels are assumed to be at the receiver's height.
  blocked = height - lit * t;
  return lit;
}

// Returns the fraction of a window in one part after `cut` cuts in four.
float part_weight(uint cut) { return 1.0 / float(1u << (2 * cut)); }

// Moves to the largest part that begins where this one ends, among the parts made by up to `most` cuts.
void next_part(inout uint at, inout uint cut, uint most) {
  const uint parts = 1u << (2 * most);
  at += parts >> (2 * cut);
  if (at < parts) cut = most - uint(findLSB(at)) / 2;
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  const uint s = d.z < 0.0 ? 1 : 0;
  const float height = abs(d.z);
  // A filter of fixed width uses the light's centre alone.
  const float horizon = kWindowTexels != 0 ? (dot(m, d) > 0.0 ? 1.0 : 0.0) : share_above_horizon(d, m, own.horizon_samples);
  if (horizon == 0.0 || !(nearest[s] < height)) return horizon;

  const float kept = height_less_bias(view, d, m) / height;
  Asking asking = Asking(d, m, s, 0.0, kept, 0.0);
  const float level = normalised(asking, height);
  asking.t = normalised(asking, height * kept);
  // An exponential is 1 at the receiver's own height: a bias would make the result lit. For esm only rounding is
  // subtracted; for evsm deviations as large as the bias are tolerated, as a least variance, which grows with the
  // exponent (Lauritzen and McCool 2008).
  const float exact = kModel == kExponential ? level - kHeightRounding : kModel == kExpVariance ? level : asking.t;
  if (kModel == kExpVariance) asking.slack = level - asking.t;
  if (kModel == kExponential) {
    asking.kept = 1.0;
    asking.t = exact;
    asking.slack = -kHeightRounding;
  }
  const vec2 ends = height_ends(nearest[s], frame.deepest[s]);

  // Step 1 finds the blockers in the light-receiver pyramid at the near plane, and their mean height. Steps 2 and 3
  // replace all blockers by one plane at this height, and find the fraction of the light seen past this plane. One loop
  // processes the parts of both windows.
  float z = min(max(nearest[s], frame.smallest_near), height), lit = 0.0, blockers = 0.0;
  bool search = kWindowTexels == 0;
  Window window = search ? window_through(view, d, frame.half_box, z) : window_of_texels(view, d, kWindowTexels);
  const uint most = kCuts > kImageCuts ? kCuts : kImageCuts, parts = 1u << (2 * most);
  uint at = 0, cut = 0;  // current part, in Morton order: index of its first smallest part, and its number of cuts
  for (;;) {
    // Cuts down to the next part that needs a mean, in a separate loop: otherwise a driver that computes both sides of
    // a branch would compute a mean for each part on the path, too.
    Image image;
    bool needs_mean = false, may_cut = false;
    while (at < parts && !needs_mean) {
      image = image_of(part_of(window, cut, at >> (2 * (most - cut))));
      const bool wider = max(image.extent.x, image.extent.y) > 1.0;  // than a texel
      if (!image.fits && wider && cut < kImageCuts) {
        ++cut;
        continue;
      }
      // If no texel of the part is nearer than the receiver, the part is lit and needs no mean.
      const bool open = kModel <= kExpVariance && heights_within(view, image.box, s).x >= asking.t;
      may_cut = cut < kCuts && wider;
      if (!open && may_cut && kSubdivision == kUniform) {
        ++cut;
        continue;
      }
      needs_mean = !open;
      if (!open) continue;
      lit += part_weight(cut);
      next_part(at, cut, most);
    }
    if (needs_mean) {
      const Box box = image.box;
      const float t = cut == 0 ? exact : plane_height(view, asking, box.face, image.centre) + asking.slack;
      float blocked;
      float share = lit_share(view, asking, box, t, search, blocked);
      if (may_cut && share >= 1.0) {
        ++cut;
        continue;
      }
      if (kCuts != 0 && share >= 1.0) share = lit_at_texels(view, asking, box, blocked);
      lit += part_weight(cut) * share;
      blockers += share < 1.0 ? part_weight(cut) * blocked : 0.0;
      next_part(at, cut, most);
      if (at < parts) continue;
    }
    if (!search) break;
    if (lit >= 1.0 || (kModel == kFourier && own.scale * lit >= 1.0)) return horizon;
    z = clamp(ends.x + blockers / (1.0 - lit) * (ends.y - ends.x), nearest[s], height);
    window = window_through(view, d, frame.half_box, z);
    search = false;
    lit = blockers = 0.0;
    at = cut = 0;
  }
  // With a fixed filter width, the step's scale applies to the result, as published; with a light, it would apply to
  // the penumbra.
  if (kModel == kFourier && kWindowTexels != 0) lit *= own.scale;
  const float v = clamp((lit - own.leak) / (1.0 - own.leak), 0.0, 1.0);
  return min(kSmoothLeak != 0 ? v * v * (3.0 - 2.0 * v) : v, horizon);
}

#include "maps/host/scalar_main.glsl"
