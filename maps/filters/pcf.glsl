// SPDX-License-Identifier: Apache-2.0
#include "maps/filters/pcf.shared.h"
#define OWN_PUSH PcfPush
#include "maps/host/look_up.glsl"

// Percentage-closer filtering (Reeves, Salesin, Cook 1987; Eisemann et al. 2009, equation 4.1): the fraction, equally
// weighted or not, of the window x window texels around the receiver whose depth test passes.

#include "maps/host/neighbours.glsl"

#ifdef OBJECT_IDS
layout(scalar, binding = FIRST_PRODUCT) readonly buffer Ids { uint ids[]; };
layout(scalar, binding = FIRST_PRODUCT + 1) readonly buffer Objects { uint object_of[]; };
#endif

// The receiver in texels of its face, and the values that all of its taps share.
struct PcfAsking {
  vec3 m;
  float h;
  Tap own_tap;
  vec2 at, step;
  uint number;  // index of the face, with FITTED_FACES
};

// Fetches the texel at `offset` texels from the receiver's own. Returns false behind the light's plane, where a
// hemicube's window may reach and no surface is between light and receiver.
bool tap_beside(LightView view, PcfAsking asking, vec2 offset, out Tap tap) {
  const Tap own_tap = asking.own_tap;
#ifdef FITTED_FACES
  vec3 direction = face_direction(fitted_faces[asking.number], (floor(asking.at) + offset + 0.5) / float(lookup.size));
  direction.z *= own_tap.mirrored;
#else
  const vec3 direction = neighbour(own_tap, asking.step, offset);
#endif
  tap = own_tap;
  if (!(direction.z * own_tap.mirrored > 0.0)) return false;
  tap = fetch(view, 0, lookup.size, direction * own_tap.along);
  return true;
}

// Returns whether the texel does not shade the receiver. With OBJECT_IDS no object shades itself (Brabec and Seidel
// 2002).
bool is_lit(LightView view, PcfAsking asking, vec2 offset) {
  Tap tap;
  if (!tap_beside(view, asking, offset, tap)) return true;
#ifdef OBJECT_IDS
  const uint id = tap.depth < tap.far ? ids[tap.number] : kNoId;
  if (id != kNoId && object_of[id] == receiver_object) return true;
#endif
  return !texel_blocks(tap, asking.m, asking.h, tap.along, max(abs(offset.x), abs(offset.y)));
}

// Returns the weight of a texel at distance `beside`, in texels, from the middle of the window.
float weight_of(vec2 beside) {
  if (own.weights != kGaussian) return 1.0;
  const float deviation = 0.25 * float(own.window);
  return exp(-0.5 * dot(beside, beside) / (deviation * deviation));
}

// Returns the result of taps spread over the disk in the window (Uralsky 2005), rotated by another angle at every
// receiver. The outermost taps come first; with `stages` of 2, the others are left out if these agree.
float spread_taps(LightView view, PcfAsking asking, vec3 d) {
  uint bits = floatBitsToUint(d.x) * 0x9e3779b1u ^ floatBitsToUint(d.y) * 0x85ebca77u ^ floatBitsToUint(d.z) * 0xc2b2ae3du;
  bits = (bits ^ bits >> 15) * 0x2c1b3c6du;
  bits ^= bits >> 12;
  const float turn = float(bits >> 8) * (6.283185307 / 16777216.0);
  const uint first_stage = max(own.taps / 4, min(own.taps, 4));
  float lit = 0.0, total = 0.0;
  for (uint k = 0; k < own.taps; ++k) {
    const float place = float(own.taps - k) - 0.5, angle = turn + 2.399963230 * place;
    const vec2 beside = 0.5 * float(own.window) * sqrt(place / float(own.taps)) * vec2(cos(angle), sin(angle));
    const float weight = weight_of(beside);
    total += weight;
    if (is_lit(view, asking, floor(asking.at + beside) - floor(asking.at))) lit += weight;
    if (own.stages == 2 && k + 1 == first_stage && (lit == 0.0 || lit == total)) break;
  }
  return lit / total;
}

// Pagot et al. 2004: compares only the texels of the least and the greatest depth in a window, and as a third the texel
// nearest to the middle between these depths.
float of_kept(LightView view, PcfAsking asking, vec2 first) {
  vec2 at[3] = vec2[3](first, first, first);
  float least = 4.0 * view.far, greatest = -1.0, off = 4.0 * view.far;
  for (uint turn = 0; turn < own.keep - 1; ++turn) {
    for (uint k = 0; k < own.window * own.window; ++k) {
      const vec2 offset = first + vec2(k % own.window, k / own.window);
      Tap tap;
      const float depth = tap_beside(view, asking, offset, tap) ? tap.depth : view.far;
      if (turn == 0) {
        if (depth < least) at[0] = offset;
        if (depth > greatest) at[1] = offset;
        least = min(least, depth);
        greatest = max(greatest, depth);
      } else {
        // If two depths are equally near to the middle, the lesser one counts.
        const float middle = 0.5 * (least + greatest);
        const float beside = abs(depth - middle) + (depth > middle ? view.far / 1048576.0 : 0.0);
        if (beside < off) at[2] = offset;
        off = min(off, beside);
      }
    }
  }
  float lit = 0.0;
  for (uint k = 0; k < own.keep; ++k) lit += is_lit(view, asking, at[k]) ? 1.0 : 0.0;
  return lit / float(own.keep);
}

// Luft and Deussen 2006: the window's mean depth, no farther than the receiver's, and a smooth test. The receiver is
// dark where it lies `softness` of its own depth behind the mean depth.
float of_mean_depth(LightView view, PcfAsking asking, vec2 first) {
  const float depth = asking.own_tap.along;
  float sum = 0.0, total = 0.0;
  for (uint k = 0; k < own.window * own.window; ++k) {
    const vec2 place = vec2(k % own.window, k / own.window);
    const float weight = weight_of(place - 0.5 * (float(own.window) - 1.0));
    Tap tap;
    total += weight;
    sum += weight * (tap_beside(view, asking, first + place, tap) ? min(tap.depth, depth) : depth);
  }
  const float behind = depth - sum / total - lookup.bias * asking.own_tap.texel * depth;
  return 1.0 - smoothstep(0.0, own.softness * depth, behind);
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  PcfAsking asking;
  asking.m = m;
  asking.h = dot(m, d);
  if (asking.h <= 0.0) return 0.0;  // the light's centre is below the receiver's horizon
  asking.own_tap = fetch(view, 0, lookup.size, d);
#ifdef FITTED_FACES
  vec2 place;
  asking.number = find_face(vec3(d.xy, abs(d.z)), d.z < 0.0 ? 1 : 0, place);
  if (asking.number == table_of_faces.count) return 1.0;
  asking.at = place * float(lookup.size);
#else
  const FaceHit hit = face_hit(view, d);
  asking.step = (hit.upper - hit.lower) / float(lookup.size);
  asking.at = (hit.f.xy / hit.f.z - hit.lower) / asking.step;
#endif
  if (own.taps != 0) return spread_taps(view, asking, d);

  const float width = float(own.window);
  const vec2 texel = floor(asking.at);
  // A window has as many texels on either side of the receiver as possible: an odd window is centred on the receiver's
  // texel, an even one on the texel border nearest to the receiver. Bilinear: the window is centred on the receiver,
  // and texels at its border are weighted by their part inside; with one texel these are the four of a bilinear test.
  const bool bilinear = own.weights == kBilinear;
  const vec2 first = floor(asking.at - 0.5 * width + (bilinear ? 0.0 : 0.5)) - texel;
  if (own.keep != 0) return of_kept(view, asking, first);
  if (own.test == kByMeanDepth) return of_mean_depth(view, asking, first);
  const uint count = own.window + (bilinear ? 1 : 0);
  float lit = 0.0, total = 0.0;  // integers if all weights are equal
  for (uint j = 0; j < count; ++j) {
    for (uint i = 0; i < count; ++i) {
      const vec2 offset = first + vec2(i, j);
      float weight = weight_of(vec2(i, j) - 0.5 * (width - 1.0));
      if (bilinear) {
        const vec2 lower = texel + offset;
        const vec2 part = min(lower + 1.0, asking.at + 0.5 * width) - max(lower, asking.at - 0.5 * width);
        weight = max(part.x, 0.0) * max(part.y, 0.0);
      }
      total += weight;
      if (is_lit(view, asking, offset)) lit += weight;
    }
  }
  return lit / total;
}

#include "maps/host/scalar_main.glsl"
