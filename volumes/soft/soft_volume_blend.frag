// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/wedge_raster.shared.h"
#include "volumes/soft/soft_volume_blend.shared.h"
#include "volumes/raster/determinant.glsl"
#include "volumes/wedges/radial_coverage.glsl"

// Contribution of one silhouette edge of one occluder to each quarter of a rectangle light, with the box of the edge's
// piece there (V. Forest, L. Barthe, M. Paulin 2006). The quarters' common corner is the centre, so one count serves
// all.

layout(scalar, binding = 0) readonly buffer Faces { WedgeFace faces[]; };  // used by the vertex shader; both stages
                                                                           // have the same descriptor set
layout(scalar, binding = 1) readonly buffer Receivers { WedgeReceiver receivers[]; };
layout(scalar, binding = 2) buffer Sums { int64_t sums[]; };
layout(scalar, binding = 3) writeonly buffer Doubts { uint doubts[]; };
layout(scalar, push_constant) uniform Push { WedgePush push; };

layout(location = 0) flat in vec3 face_a;
layout(location = 1) flat in vec3 face_b;
layout(location = 2) flat in int face_weight;

#include "volumes/raster/foot.glsl"

int64_t fixed_point(double x) { return int64_t(round(x / kSumUnit)); }

/// Returns the area of the quarter [0, 1]² between the directions (1, 0) and q, as seen from the centre (0, 0).
double quarter_fan(dvec2 q) { return q.y <= q.x ? 0.5LF * q.y / q.x : 1.0LF - 0.5LF * q.x / q.y; }

void add_to_quarter(uint quarter, uint slot, Segment cut, int weight) {
  const dvec2 mirror = dvec2((quarter & 1) != 0 ? -1.0LF : 1.0LF, (quarter & 2) != 0 ? -1.0LF : 1.0LF);
  const dvec3 a = cut.from * dvec3(mirror, 1.0LF), b = cut.to * dvec3(mirror, 1.0LF);
  double first = 0.0LF, last = 1.0LF;
  cut_range(a.x, b.x, first, last);
  cut_range(a.y, b.y, first, last);
  if (!(first < last)) return;
  const dvec3 from = a + (b - a) * first, to = a + (b - a) * last;
  const dvec2 q0 = clamp(from.xy / from.z, 0.0LF, 1.0LF), q1 = clamp(to.xy / to.z, 0.0LF, 1.0LF);
  const double cone = quarter_fan(q1) - quarter_fan(q0) - 0.5LF * (q0.x * q1.y - q0.y * q1.x);
  const uint at = slot * kBlendWords + quarter * kQuarterWords;
  atomicAdd(sums[at], fixed_point(cone * mirror.x * mirror.y * double(weight)));
  const dvec2 lower = 1.0LF - min(q0, q1), upper = max(q0, q1);
  atomicMax(sums[at + 1], fixed_point(lower.x));
  atomicMax(sums[at + 2], fixed_point(lower.y));
  atomicMax(sums[at + 3], fixed_point(upper.x));
  atomicMax(sums[at + 4], fixed_point(upper.y));
}

/// Adds the edge q0 q1 to a point if the segment from the centre to the point crosses it. If the segment passes through
/// an end where two edges meet, one of the two counts.
void add_to_point(uint point, uint slot, dvec2 q0, dvec2 q1, int weight) {
  const dvec2 to[8] = dvec2[](dvec2(1, 0), dvec2(1, 1), dvec2(0, 1), dvec2(-1, 1), dvec2(-1, 0), dvec2(-1, -1),
                              dvec2(0, -1), dvec2(1, -1));
  const dvec2 g = to[point], direction = q1 - q0, rest = g - q0;
  const double from_side = g.x * q0.y - g.y * q0.x, to_side = g.x * q1.y - g.y * q1.x;
  const double beyond = direction.x * rest.y - direction.y * rest.x, here = direction.y * q0.x - direction.x * q0.y;
  if ((from_side < 0.0LF) == (to_side < 0.0LF) || (beyond < 0.0LF) == (here < 0.0LF)) return;
  atomicAdd(sums[slot * kBlendWords + kPointWord + point], int64_t(from_side < 0.0LF ? weight : -weight));
}

void main() {
  const uvec2 pixel = uvec2(gl_FragCoord.xy);
  const uint slot = pixel.y * push.width + pixel.x;
  const WedgeReceiver receiver = receivers[slot];
  if (receiver.counted == 0) return;
  const dvec3 p = dvec3(receiver.p), a = dvec3(face_a), b = dvec3(face_b);
  const Foot foot = foot_of(p);
  const dvec3 from = project(a - p, foot), to = project(b - p, foot);
  const Segment cut = cut_by_square(from, to);
  if (!cut.any) return;
  const Cone cone = cone_of(cut, turn_of(a, b, p, foot), size_of(a, b, p, from, to), false);
  if (cone.doubtful) {
    doubts[slot] = 1;
    return;
  }
  const int weight = facing_of(foot) * face_weight;
  for (uint quarter = 0; quarter < 4; ++quarter) add_to_quarter(quarter, slot, cut, weight);
  const dvec2 q0 = cut.from.xy / cut.from.z, q1 = cut.to.xy / cut.to.z;
  for (uint point = 0; point < kPoints; ++point) add_to_point(point, slot, q0, q1, weight);
}
