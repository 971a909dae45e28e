#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "volumes/raster/volume_count.shared.h"
#include "volumes/raster/wedge_raster.shared.h"
#include "volumes/raster/determinant.glsl"

// What one silhouette edge adds to the part of the light that is hidden from p. Outside the edge's penumbra nothing of
// it is left once it is cut by the light: no plane of the wedge is looked at again.

layout(constant_id = 0) const uint kShape = 0;
layout(constant_id = 1) const uint kMeasure = 0;

layout(scalar, binding = 0) readonly buffer Faces { WedgeFace faces[]; };  // the vertex shader's; one set for both
layout(scalar, binding = 1) readonly buffer Receivers { WedgeReceiver receivers[]; };
layout(scalar, binding = 2) buffer Sums { int64_t sums[]; };
layout(scalar, binding = 3) writeonly buffer Doubts { uint doubts[]; };
layout(scalar, binding = 4) readonly buffer Table { double table[]; };  // of kMeasure
layout(scalar, push_constant) uniform Push { WedgePush push; };

layout(location = 0) flat in vec3 face_a;
layout(location = 1) flat in vec3 face_b;
layout(location = 2) flat in int face_weight;

#include "volumes/wedges/radial_coverage.glsl"
#include "volumes/raster/foot.glsl"
#include "volumes/soft/coverage_table.glsl"
#include "volumes/wedges/texture_weights.glsl"

/// Of the light, what lies beyond the edge from q0 to q1.
double share_of(Cone cone, dvec2 q0, dvec2 q1) {
  const double whole = kShape == kDisk ? 2.0LF * kHalfPi : 4.0LF;
  if (kMeasure == kTable) {
    const bool disk = kShape == kDisk;
    const TablePoint from = disk ? disk_point(q0) : square_point(q0), to = disk ? disk_point(q1) : square_point(q1);
    // The table's cones do not go round the centre; this one goes round as the edge itself does.
    const double round_trips = round((cone.sector - (to.fan - from.fan)) / whole);
    return table[from.index * uint(kTableSide * kTableSide) + to.index] + round_trips;
  }
  if (kMeasure == kTexture) {
    const uvec2 texels = uvec2(push.texels & 0xffffu, push.texels >> 16);
    const double round_trips = round((cone.sector - (cone.to - cone.from)) / whole);
    // Without the ways from both ends to the rim: neighbours have them, too, the other way round.
    return weight_of_fan(cone.to, texels) - weight_of_fan(cone.from, texels) + round_trips -
           weight_left_of(q0, q1, texels);
  }
  return (cone.sector - cone.triangle) / whole;
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
  const Cone cone = cone_of(cut, turn_of(a, b, p, foot), size_of(a, b, p, from, to), kShape == kDisk);
  if (cone.doubtful) {
    doubts[slot] = 1;
    return;
  }
  const double share = share_of(cone, cut.from.xy / cut.from.z, cut.to.xy / cut.to.z);
  atomicAdd(sums[slot], int64_t(round(share * double(facing_of(foot) * face_weight) / kSumUnit)));
}
