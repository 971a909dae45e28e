// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/wedge_raster.shared.h"
#include "volumes/counters/packed_counters.shared.h"
#include "volumes/raster/determinant.glsl"

// Change of the counters of light samples by one silhouette edge (V. Forest, L. Barthe, M. Paulin 2008): k where the
// segment from the light's centre c to the light sample l crosses the edge as seen from p, that is where the edge meets
// the triangle p c l. Five signs of determinants decide this; where one of them may be due to rounding, the host
// decides.

layout(constant_id = 0) const uint kSamples = 16;
layout(constant_id = 1) const uint kBits = 16;             // bits of a counter

layout(scalar, binding = 0) readonly buffer Faces { WedgeFace faces[]; };  // used by the vertex shader; both stages
                                                                           // have the same descriptor set
layout(scalar, binding = 1) readonly buffer Receivers { WedgeReceiver receivers[]; };
layout(scalar, binding = 2) buffer Sums { int64_t sums[]; };
layout(scalar, binding = 3) buffer Doubts { uint doubts[]; };              // a bit for each light sample
// A box around c and the light samples in the light's frame: lower X, Y, upper X, Y; half of its margin; the largest
// distance of a sample from the light's plane, in lengths of n; then the light samples, x y z.
layout(scalar, binding = 4) readonly buffer Samples { double samples[]; };
layout(scalar, push_constant) uniform Push { WedgePush push; };

layout(location = 0) flat in vec3 face_a;
layout(location = 1) flat in vec3 face_b;
layout(location = 2) flat in int face_weight;

const int kNoTurn = 2;
#include "volumes/raster/foot.glsl"

const uint kEach = 64 / kBits;                             // counters in a word
const uint kWords = (kSamples + kEach - 1) / kEach;

const uint kUp = 1, kDown = 2, kDoubt = 4;
uint signs(double value, double bound) { return value > bound ? kUp : value < -bound ? kDown : kDoubt; }
uint opposite(uint seen) { return (seen & kDoubt) | (seen & kUp) << 1 | (seen & kDown) >> 1; }
bool differ(uint seen) { return (seen & (kUp | kDown)) == (kUp | kDown); }
bool doubted(uint seen) { return (seen & kDoubt) != 0; }

dvec3 sample_at(uint j) {
  const uint at = kPackedHead + 3 * j;
  return dvec3(samples[at], samples[at + 1], samples[at + 2]);
}

/// Clips the part of an edge where an affine function, d at one end and e at the other, is negative.
void cut_range(double d, double e, inout double first, inout double last) {
  const double at = d / (d - e);
  if (d < 0.0LF) first = e < 0.0LF ? 2.0LF : max(first, at);
  if (d >= 0.0LF && e < 0.0LF) last = min(last, at);
}

/// Returns false only if the edge, seen from p, appears outside of the box around c and the light samples: most
/// fragments then need no sign. With p at distance G from the light's plane, a point at distance g from that plane
/// appears displaced by less than 2 g / G of its distance from p's foot. If that may exceed the box's margin, nothing
/// is skipped.
bool may_appear(dvec3 a, dvec3 b, dvec3 p) {
  const Foot foot = foot_of(p);
  const dvec3 from = project(a - p, foot), to = project(b - p, foot);
  const dvec2 lower = dvec2(samples[0], samples[1]), upper = dvec2(samples[2], samples[3]);
  const dvec2 away = abs(foot.at) + max(abs(lower), abs(upper));
  const double far = away.x + away.y, terms = norm1(a - p) + norm1(b - p) + norm1(p - push.c) * (abs(from.z) + abs(to.z));
  const double slack =
      kAppearError * terms * (norm1(push.u_dual) + norm1(push.v_dual) + norm1(push.n) * abs(foot.inverse) * far);
  double first = 0.0LF, last = 1.0LF;
  cut_range(upper.x * from.z - from.x + slack, upper.x * to.z - to.x + slack, first, last);
  cut_range(upper.y * from.z - from.y + slack, upper.y * to.z - to.y + slack, first, last);
  cut_range(from.x - lower.x * from.z + slack, to.x - lower.x * to.z + slack, first, last);
  cut_range(from.y - lower.y * from.z + slack, to.y - lower.y * to.z + slack, first, last);
  return !(first >= last) || samples[5] * abs(foot.inverse) * far > samples[4];
}

void main() {
  const uvec2 pixel = uvec2(gl_FragCoord.xy);
  const uint slot = pixel.y * push.width + pixel.x;
  const WedgeReceiver receiver = receivers[slot];
  if (receiver.counted == 0) return;
  const dvec3 p = dvec3(receiver.p), a = dvec3(face_a), b = dvec3(face_b);
  const uint looked_at = may_appear(a, b, p) ? kSamples : 0;
  const dvec3 to_a = a - p, to_b = b - p, to_c = push.c - p, a_from_c = a - push.c, b_from_c = b - push.c;
  // Sign of (p, c, a, b): the side of the plane p a b that c is on.
  const Value center = det(to_c, to_a, to_b);
  const uint at_center = signs(center.value, center.bound);
  const int change = (at_center & kUp) != 0 ? -face_weight : face_weight;

  // Light samples that are not certainly on the same side as c; there are hardly any in most of a footprint. Some
  // devices execute code that a branch skips, but run no more loop iterations than needed: so loops do the skipping.
  uint left = 0;
  for (uint j = 0; j < looked_at; ++j) {
    const Value here = det(sample_at(j) - p, to_a, to_b);
    const uint both = at_center | opposite(signs(here.value, here.bound));
    left |= differ(both) ? 0 : 1u << j;
  }
  int64_t words[kWords];
  for (uint i = 0; i < kWords; ++i) words[i] = 0;
  uint doubt = 0;
  bool any = false;
  for (; left != 0; left &= left - 1) {
    const uint j = findLSB(left);
    const dvec3 l = sample_at(j), to_l = l - p;
    const Value here = det(to_l, to_a, to_b), beyond = det(l - push.c, a_from_c, b_from_c);
    const Value first = det(to_a, to_c, to_l), last = det(to_b, to_c, to_l);
    // The line a b passes through the triangle: it passes the edges between p and c, c and l, l and p on one side.
    const uint around = at_center | opposite(signs(here.value, here.bound)) | signs(beyond.value, beyond.bound);
    const uint from = signs(first.value, first.bound), to = signs(last.value, last.bound);
    const bool apart = from == kUp && to == kUp || from == kDown && to == kDown;
    const bool clear = differ(around) || apart, open = !clear && (doubted(around) || doubted(from | to));
    doubt |= open ? 1u << j : 0;
    if (clear || open) continue;
    words[j / kEach] += int64_t(change) * (int64_t(1) << (kBits * (j % kEach)));
    any = true;
  }
  if (doubt != 0) atomicOr(doubts[slot], doubt);
  if (!any) return;
  const uint first_word = slot * (kWords + 1);
  for (uint i = 0; i < kWords; ++i) {
    if (words[i] != 0) atomicAdd(sums[first_word + i], words[i]);
  }
  atomicAdd(sums[first_word + kWords], int64_t(abs(face_weight)));
}
