#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "volumes/volume_count.shared.h"
#include "volumes/wedge_raster.shared.h"
#include "volumes/packed_counters.shared.h"
#include "volumes/determinant.glsl"

// What one silhouette edge changes the counters of light samples by (V. Forest, L. Barthe, M. Paulin 2008): k where the
// way from the light's centre c to the light sample l crosses it as seen from p, that is where the edge meets the
// triangle p c l. Five signs of determinants say so; what hangs on one that rounding may have made is for the host.

layout(constant_id = 0) const uint kSamples = 16;
layout(constant_id = 1) const uint kBits = 16;             // of a counter

layout(scalar, binding = 0) readonly buffer Faces { WedgeFace faces[]; };  // the vertex shader's; one set for both
layout(scalar, binding = 1) readonly buffer Receivers { WedgeReceiver receivers[]; };
layout(scalar, binding = 2) buffer Sums { int64_t sums[]; };
layout(scalar, binding = 3) buffer Doubts { uint doubts[]; };              // a bit a light sample
layout(scalar, binding = 4) readonly buffer Samples { double samples[]; }; // light samples, x y z
layout(scalar, push_constant) uniform Push { WedgePush push; };

layout(location = 0) flat in vec3 face_a;
layout(location = 1) flat in vec3 face_b;
layout(location = 2) flat in int face_weight;

const uint kEach = 64 / kBits;                             // counters in a word
const uint kWords = (kSamples + kEach - 1) / kEach;

const uint kUp = 1, kDown = 2, kDoubt = 4;
uint signs(double value, double bound) { return value > bound ? kUp : value < -bound ? kDown : kDoubt; }
uint opposite(uint seen) { return (seen & kDoubt) | (seen & kUp) << 1 | (seen & kDown) >> 1; }
bool differ(uint seen) { return (seen & (kUp | kDown)) == (kUp | kDown); }
bool doubted(uint seen) { return (seen & kDoubt) != 0; }

void main() {
  const uvec2 pixel = uvec2(gl_FragCoord.xy);
  const uint slot = pixel.y * push.width + pixel.x;
  const WedgeReceiver receiver = receivers[slot];
  if (receiver.counted == 0) return;
  const double nearest = double(uintBitsToFloat(receiver.counted));
  const dvec3 p = dvec3(receiver.p), a = dvec3(face_a), b = dvec3(face_b);
  const dvec3 to_a = a - p, to_b = b - p, to_c = push.c - p, a_from_c = a - push.c, b_from_c = b - push.c;
  // Of (p, c, a, b): the side of the plane p a b that c is on.
  const Value center = det(to_c, to_a, to_b);
  const uint at_center = signs(center.value, center.bound);
  const int change = (at_center & kUp) != 0 ? -face_weight : face_weight;

  int64_t words[kWords];
  for (uint i = 0; i < kWords; ++i) words[i] = 0;
  uint doubt = 0;
  bool any = false;
  for (uint j = 0; j < kSamples; ++j) {
    const dvec3 l = dvec3(samples[3 * j], samples[3 * j + 1], samples[3 * j + 2]), to_l = l - p;
    const Value here = det(to_l, to_a, to_b), beyond = det(l - push.c, a_from_c, b_from_c);
    const Value first = det(to_a, to_c, to_l), last = det(to_b, to_c, to_l);
    // The line a b goes through the triangle: between p and c, c and l, l and p it passes on one side.
    const uint around = at_center | opposite(signs(here.value, here.bound)) | signs(beyond.value, beyond.bound);
    const uint from = signs(first.value, first.bound), to = signs(last.value, last.bound);
    const bool apart = from == kUp && to == kUp || from == kDown && to == kDown;
    if (differ(around) || apart) continue;
    // How far on the way from p to the light it does: (1 − the share of p) of the crossing's barycentric coordinates.
    const double near = abs(center.value) + abs(here.value);
    const bool at_p = near <= nearest * (near + abs(beyond.value));
    if (doubted(around) || doubted(from | to) || at_p) {
      doubt |= 1u << j;
      continue;
    }
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
