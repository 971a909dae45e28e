// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "volumes/raster/wedge_raster.shared.h"
#include "volumes/soft/plateaus.shared.h"

// Depth of a view sample in the outer penumbra of one edge. The largest depth counts, as the highest plateau hides the
// others (E. Haines 2001). Twin: OuterPenumbra::depth_at.

layout(scalar, binding = 0) readonly buffer Faces { WedgeFace faces[]; };  // used by the vertex shader; both stages
                                                                           // have the same descriptor set
layout(scalar, binding = 1) readonly buffer Receivers { WedgeReceiver receivers[]; };
layout(scalar, binding = 2) buffer Sums { int64_t sums[]; };
layout(scalar, binding = 3) writeonly buffer Doubts { uint doubts[]; };
layout(scalar, binding = 4) readonly buffer Table { double table[]; };  // the radius, then the carriers' normals;
                                                                        // WedgeReceiver::counted is the carrier's index
                                                                        // plus 1
layout(scalar, push_constant) uniform Push { WedgePush push; };

layout(location = 0) flat in vec3 face_a;
layout(location = 1) flat in vec3 face_b;

/// Clips to the part of [first, last] where a linear function, d at 0 and e at 1, is not negative.
void cut_range(double d, double e, inout double first, inout double last) {
  if (d < 0.0LF && e < 0.0LF) last = -1.0LF;
  if (d < 0.0LF && e >= 0.0LF) first = max(first, d / (d - e));
  if (d >= 0.0LF && e < 0.0LF) last = min(last, d / (d - e));
}

void main() {
  const uvec2 pixel = uvec2(gl_FragCoord.xy);
  const uint slot = pixel.y * push.width + pixel.x;
  const WedgeReceiver receiver = receivers[slot];
  if (receiver.counted == 0) return;
  const dvec3 p = dvec3(receiver.p), a = dvec3(face_a), b = dvec3(face_b);
  const uint at = 3 * receiver.counted - 2;
  const dvec3 normal = dvec3(table[at], table[at + 1], table[at + 2]);
  const double height = dot(normal, push.c - p);
  const double at_a = dot(normal, a - p) / height, at_b = dot(normal, b - p) / height;
  double first = 0.0LF, last = 1.0LF;
  cut_range(at_a, at_b, first, last);
  cut_range(kHighest - at_a, kHighest - at_b, first, last);
  if (!(first <= last)) return;
  const double low = at_a + first * (at_b - at_a), high = at_a + last * (at_b - at_a);
  const dvec3 from = push.c + (a + first * (b - a) - push.c) / (1.0LF - low) - p;
  const dvec3 to = push.c + (a + last * (b - a) - push.c) / (1.0LF - high) - p;
  const double r = table[0] * low / (1.0LF - low), s = table[0] * high / (1.0LF - high);
  const dvec3 direction = to - from;
  const double square = dot(direction, direction), slope = s - r;
  double nearest = 0.0LF;
  if (square > 0.0LF) {
    const double foot = -dot(from, direction) / square, at_foot = r + foot * slope;
    const dvec3 off = from + foot * direction;
    nearest = at_foot > 0.0LF ? foot + slope * dot(off, off) / (square * at_foot) : slope > 0.0LF ? 1.0LF : 0.0LF;
  }
  nearest = clamp(nearest, 0.0LF, 1.0LF);
  const double reach = r + nearest * slope;
  const dvec3 x = from + nearest * direction;
  const double depth = 1.0LF - sqrt(dot(x, x)) / reach;
  if (!(reach > 0.0LF) || !(depth > 0.0LF)) return;
  atomicMax(sums[slot], int64_t(round(depth / kSumUnit)));
}
