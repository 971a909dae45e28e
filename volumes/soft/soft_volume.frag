// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/wedge_raster.shared.h"
#include "volumes/raster/determinant.glsl"

// Contribution of one silhouette edge to the part of the light that is hidden from p. Outside of the edge's penumbra
// nothing of the edge remains after clipping by the light, so no plane of the wedge is tested.

layout(constant_id = 0) const uint kShape = 0;
layout(constant_id = 1) const uint kMeasure = 0;
// How the side of the light's centre on which an edge passes is decided: 0: exactly; 1: by rounded floats; 2: by
// rounded floats, and the layers between the centre and the voters are added up, too.
layout(constant_id = 2) const uint kSides = 0;
const bool kRounded = kSides != 0, kVote = kSides == 2;

layout(scalar, binding = 0) readonly buffer Faces { WedgeFace faces[]; };  // used by the vertex shader; both stages
                                                                           // have the same descriptor set
layout(scalar, binding = 1) readonly buffer Receivers { WedgeReceiver receivers[]; };
layout(scalar, binding = 2) buffer Sums { int64_t sums[]; };
layout(scalar, binding = 3) writeonly buffer Doubts { uint doubts[]; };
layout(scalar, binding = 4) readonly buffer Table { double table[]; };  // data for kMeasure
layout(scalar, push_constant) uniform Push { WedgePush push; };

layout(location = 0) flat in vec3 face_a;
layout(location = 1) flat in vec3 face_b;
layout(location = 2) flat in int face_weight;

#include "volumes/wedges/radial_coverage.glsl"
#include "volumes/raster/foot.glsl"
#include "volumes/soft/coverage_table.glsl"
#include "volumes/wedges/texture_weights.glsl"

/// Returns the share of the light beyond the edge from q0 to q1.
double share_of(Cone cone, dvec2 q0, dvec2 q1) {
  const double whole = kShape == kDisk ? 2.0LF * kHalfPi : 4.0LF;
  if (kMeasure == kTable) {
    const bool disk = kShape == kDisk;
    const TablePoint from = disk ? disk_point(q0) : square_point(q0), to = disk ? disk_point(q1) : square_point(q1);
    // The table's cones do not wind around the centre; this adds the windings of the edge itself.
    const double round_trips = round((cone.sector - (to.fan - from.fan)) / whole);
    return table[from.index * uint(kTableSide * kTableSide) + to.index] + round_trips;
  }
  if (kMeasure == kTexture) {
    const uvec2 texels = uvec2(push.texels & 0xffffu, push.texels >> 16);
    const double round_trips = round((cone.sector - (cone.to - cone.from)) / whole);
    // The segments from both ends to the rim are omitted: the neighbouring edges have them in the opposite direction.
    return weight_of_fan(cone.to, texels) - weight_of_fan(cone.from, texels) + round_trips -
           weight_left_of(q0, q1, texels);
  }
  return (cone.sector - cone.triangle) / whole;
}

/// Returns the side of the plane (c, a, b) that p is on, in float, as a fragment shader of 2003 would decide it.
int rounded_turn_of(dvec3 a, dvec3 b, dvec3 p, Foot foot) {
  const vec3 A = vec3(a - push.c), B = vec3(b - push.c), P = vec3(p - push.c);
  return dot(cross(A, B), P) < 0.0 ? -facing_of(foot) : facing_of(foot);
}

/// Returns by how much the number of layers changes at this edge on the segment from the centre to a voter, q; the edge
/// turns around the centre by `turn`. The tests are half open, so that the segment passes each vertex on one definite
/// side.
int layers_between(Segment cut, int turn, dvec2 q) {
  const dvec2 from = cut.from.xy - q * cut.from.z, to = cut.to.xy - q * cut.to.z;
  const int turn_at_q = from.x * to.y - from.y * to.x < 0.0LF ? -1 : 1;
  const bool above = q.x * cut.from.y - q.y * cut.from.x < 0.0LF, below = q.x * cut.to.y - q.y * cut.to.x < 0.0LF;
  return turn != turn_at_q && above != below ? turn : 0;
}

void main() {
  const uvec2 pixel = uvec2(gl_FragCoord.xy);
  const uint slot = pixel.y * push.width + pixel.x;
  const WedgeReceiver receiver = receivers[slot];
  if (receiver.counted == 0) return;
  const dvec3 p = dvec3(receiver.p), a = dvec3(face_a), b = dvec3(face_b);
  const Foot foot = foot_of(p);
  const dvec3 from = project(a - p, foot), to = project(b - p, foot);
  const Segment cut = kShape == kDisk ? cut_by_disk(from, to) : cut_by_square(from, to);
  if (!cut.any) return;
  const int turn = kRounded ? rounded_turn_of(a, b, p, foot) : turn_of(a, b, p, foot);
  const Cone cone = cone_of(cut, turn, size_of(a, b, p, from, to), kShape == kDisk);
  if (!kRounded && cone.doubtful) {
    doubts[slot] = 1;
    return;
  }
  const double share = share_of(cone, cut.from.xy / cut.from.z, cut.to.xy / cut.to.z);
  const uint words = kVote ? 1 + kVoters : 1;
  for (uint i = 0; kVote && i < kVoters; ++i) {
    const int change = layers_between(cut, turn, kVoterAt[i]);
    if (change != 0) atomicAdd(sums[slot * words + 1 + i], int64_t(change * facing_of(foot) * face_weight));
  }
  atomicAdd(sums[slot * words], int64_t(round(share * double(facing_of(foot) * face_weight) / kSumUnit)));
}
