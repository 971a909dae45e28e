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

// A linear ramp between the front and the back plane of a wedge, instead of the count's step at its edge (T.
// Akenine-Möller, U. Assarsson 2002). Twin: ramp_sum.

layout(scalar, binding = 0) readonly buffer Faces { WedgeFace faces[]; };  // used by the vertex shader; both stages
                                                                           // have the same descriptor set
layout(scalar, binding = 1) readonly buffer Receivers { WedgeReceiver receivers[]; };
layout(scalar, binding = 2) buffer Sums { int64_t sums[]; };
layout(scalar, binding = 3) writeonly buffer Doubts { uint doubts[]; };
layout(scalar, binding = 4) readonly buffer Planes { double planes[]; };  // front, back and two sides of each edge
layout(scalar, push_constant) uniform Push { WedgePush push; };

layout(location = 0) flat in vec3 face_a;
layout(location = 1) flat in vec3 face_b;
layout(location = 2) flat in int face_weight;
layout(location = 3) flat in uint face_number;

/// Returns the height, computed in the host's order of operations, so that both see p on the same side.
double height(uint plane, dvec3 p) {
  const uint at = 16 * face_number + 4 * plane;
  precise const double h = planes[at] * p.x + planes[at + 1] * p.y + planes[at + 2] * p.z + planes[at + 3];
  return h;
}

void main() {
  const uvec2 pixel = uvec2(gl_FragCoord.xy);
  const uint slot = pixel.y * push.width + pixel.x;
  const WedgeReceiver receiver = receivers[slot];
  if (receiver.counted == 0) return;
  const dvec3 p = dvec3(receiver.p);
  const double front = height(0, p), back = height(1, p);
  if (front < 0.0LF || back < 0.0LF || height(2, p) < 0.0LF || height(3, p) < 0.0LF) return;
  const Value side = det(dvec3(face_a) - push.c, dvec3(face_b) - push.c, p - push.c);
  // The host decides if p is on the plane of the edge, or if the wedge's width at p is within the twin's
  // height_error().
  const double reach = double(abs(receiver.p.x) + abs(receiver.p.y) + abs(receiver.p.z)) +
                       double(abs(face_a.x) + abs(face_a.y) + abs(face_a.z)) +
                       double(abs(face_b.x) + abs(face_b.y) + abs(face_b.z));
  if (abs(side.value) <= side.bound || !(front + back > reach / 17592186044416.0LF)) {
    doubts[slot] = 1;
    return;
  }
  const double ramp = front / (front + back) - (side.value > 0.0LF ? 0.0LF : 1.0LF);
  atomicAdd(sums[slot], int64_t(round(ramp * double(face_weight) / kSumUnit)));
}
