#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/filters/vssm.shared.h"
#define OWN_PUSH VssmPush
#include "maps/host/look_up.glsl"
#define PREFILTER_FIRST 6
#include "maps/products/prefilter.glsl"

layout(constant_id = 2) const uint kModel = kVariance;

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };
layout(scalar, binding = 5) readonly buffer Frame { MapFrame frame; };
layout(scalar, binding = 11) readonly buffer Pattern { vec2 pattern[]; };  // light points in its basis
#include "maps/filters/horizon.glsl"

// Soft shadows as pcss finds them (pcss.comp), from statistics of whole windows in place of taps. Heights are t in
// [0, 1], see prefilter_value.glsl; "lit" is the share of a window's texels that are not nearer than the receiver.

const float kLog2E = 1.4426950408889634;
// Means are right to about 2^-23 (24 binary digits, sums of float32): below this a variance is rounding.
const float kLeastVariance = 1.0 / 4194304.0;

// Of esm: a height is off by a few 2^-24 of its range, its exponential by up to 80 times that.
const float kHeightRounding = 1.0 / 1048576.0, kBeyondRounding = 1.0 / 1024.0;

// Chebyshev's bound (Donnelly and Lauritzen 2006): no more than this share of a distribution lies at x or beyond.
float chebyshev(float mean, float variance, float x) {
  return x <= mean ? 1.0 : variance / (variance + (x - mean) * (x - mean));
}

// Exponentials are read relative to the receiver's own, exp(c (t_q - t)) and exp(-c (t_q - t)): then it is at 1. This is
// the power of two by which the mean of function i is multiplied.
float log2_scale(uint i, float t) {
  const float up = own.exponent * (1.0 - t) * kLog2E, down = own.exponent * t * kLog2E;
  if (kModel == kExponential) return i == 0 ? up : 0.0;
  if (kModel != kExpVariance || i == 4) return 0.0;
  return (i < 2 ? up : down) * (i % 2 == 0 ? 1.0 : 2.0);
}

// The exponential where it is below 1, texel by texel (Annen, Mertens et al. 2008, section 3.4); of a large box, some.
const uint kFallbackTaps = 16;  // along an axis
float lit_texel_by_texel(LightView view, Box box, float t, uint s) {
  if (!(box.inside > 0.0)) return 1.0;  // beside the map there is nothing
  const vec2 first = floor(box.lower), extent = ceil(box.upper) - first;
  const uvec2 count = uvec2(min(extent, vec2(kFallbackTaps)));
  float sum = 0.0;
  for (uint j = 0; j < count.y; ++j) {
    for (uint i = 0; i < count.x; ++i) {
      const uvec2 at = uvec2(first + (vec2(i, j) + 0.5) * extent / vec2(count));
      const uint texel = (box.face * table.size + at.y) * table.size + at.x;
      const float depth = maps[texel];
      const bool sideways = box.face != view.side[s].first_face;
      const float height = sideways ? (float(at.y) + 0.5) / float(table.size) : 1.0;
      const float q = depth < 1.0 ? normalised_height(depth * view.far * height, nearest[s], frame.deepest[s]) : 1.0;
      sum += min(exp(own.exponent * (q - t)), 1.0);
    }
  }
  return box.inside * sum / float(count.x * count.y) + (1.0 - box.inside);
}

// The share of the window that is lit; if `search`, `blocker` is the mean height of what is not, in t.
float lit_share(LightView view, Box box, float t, uint s, bool search, out float blocker) {
  // Lauritzen and McCool 2008: the layer that holds t knows nothing of heights beside it. One layer's mean is that of t.
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
    if (kModel == kVariance) function = i < 2 ? 2 * layer + i : 2 * own.count;  // the last is t
    const float found = mean_over(function, box, log2_scale(i, t));
    if (kModel != kFourier) {
      mean[i] = found;
    } else if (i == 4 * own.count) {
      blockers += 0.5 * found;
    } else {
      // Annen et al. 2007 (Eisemann et al. 2009, equation 4.6): lit = 1/2 + 2 sum of sin(c_k (t_q - t)) / c_k, with heights
      // that span less than half the period, and the sum of (1 - lit) t_q by the same series (Annen et al. 2008). Stored
      // are sin, cos, t sin and t cos.
      const float c = (2.0 * float(i / 4) + 1.0) * 3.14159265358979, at = c * fourier_span(own.count) * t;
      const float term = 2.0 / c * (2.0 * found - 1.0) * (i % 2 == 0 ? cos(at) : -sin(at));
      if (i % 4 < 2) {
        lit += term;
      } else {
        blockers -= term;
      }
    }
  }

  float height = 0.0;  // mean of t
  if (kModel == kFourier) {
    blocker = lit < 1.0 ? blockers / (1.0 - lit) : t;
    return lit;
  } else if (kModel == kVariance) {
    const float off = mean[0] - 0.5, variance = mean[1] - off * off;
    lit = chebyshev(mean[0], max(variance, kLeastVariance * layers * layers), t * layers - float(layer));
    height = own.count == 1 ? mean[0] : mean[2];
  } else if (kModel == kExpVariance) {
    const float least = kLeastVariance * own.exponent * own.exponent;
    lit = min(chebyshev(mean[0], max(mean[1] - mean[0] * mean[0], least), 1.0),
              chebyshev(-mean[2], max(mean[3] - mean[2] * mean[2], least), -1.0));
    height = mean[4];
  } else {
    lit = mean[0];
    if (lit > 1.0 + kBeyondRounding) lit = own.fallback != 0 ? lit_texel_by_texel(view, box, t, s) : 1.0;
    lit = min(lit, 1.0);
    height = mean[1];
  }
  // Yang et al. 2010: what is lit is taken to be at the receiver's height.
  blocker = lit < 1.0 ? (height - lit * t) / (1.0 - lit) : t;
  return lit;
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  const uint s = d.z < 0.0 ? 1 : 0;
  const float horizon = share_above_horizon(d, m, own.horizon_samples), height = abs(d.z);
  if (!(nearest[s] < height)) return horizon;
  // An exponential is 1 at the receiver's own height: it needs no bias, and would make light of one.
  const float t = kModel == kExponential ? normalised_height(height, nearest[s], frame.deepest[s]) - kHeightRounding
                                         : normalised_height(height_less_bias(view, d, m), nearest[s], frame.deepest[s]);

  const vec2 ends = height_ends(nearest[s], frame.deepest[s]);

  // 1. Blockers in the light-receiver pyramid where it passes the near plane, and their mean height. 2, 3. As if all of
  // them were one plane there: the share of the light seen past it.
  float z = min(max(nearest[s], frame.smallest_near), height), lit = 1.0;
  for (uint window = 0; window < 2; ++window) {
    float blocker;
    lit = lit_share(view, box_through(view, d, frame.half_box, z), t, s, window == 0, blocker);
    if (window == 0 && lit >= 1.0) return horizon;
    z = clamp(ends.x + blocker * (ends.y - ends.x), nearest[s], height);
  }
  if (kModel == kFourier) lit *= own.scale;
  return min(clamp((lit - own.leak) / (1.0 - own.leak), 0.0, 1.0), horizon);
}

#include "maps/host/scalar_main.glsl"
