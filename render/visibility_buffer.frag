// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "render/visibility_buffer.shared.h"

// Decides coverage and order in double: GLSL twin of visibility::cover. Two passes over the same proposals: the first
// keeps the smallest t of each pixel, the second, among proposals with exactly that t, the smallest rank.

layout(constant_id = 0) const uint kSecondPass = 0;

layout(scalar, binding = 0) readonly buffer Corners { vec3 corners[]; };
layout(scalar, binding = 1) readonly buffer Ranks { uint ranks[]; };
layout(scalar, binding = 2) buffer Nearest { uint64_t nearest[]; };  // bits of t: positive doubles order like integers
layout(scalar, binding = 3) buffer Winner { uint winner[]; };
layout(scalar, push_constant) uniform Push { VisibilityBufferPush camera; };

layout(location = 0) flat in uint triangle;

// `precise` throughout: two triangles must compute the same sign for their common edge.
double cross_dot(dvec3 d, dvec3 a, dvec3 b) {
  precise const double x = a.y * b.z - a.z * b.y;
  precise const double y = a.z * b.x - a.x * b.z;
  precise const double z = a.x * b.y - a.y * b.x;
  precise const double result = d.x * x + d.y * y + d.z * z;
  return result;
}

void main() {
  const uvec2 pixel = uvec2(uint(gl_FragCoord.x), uint(gl_FragCoord.y) + camera.first_row);
  precise const double ndc_x = 2.0 * (double(pixel.x) + 0.5) / double(camera.width) - 1.0;
  precise const double ndc_y = 1.0 - 2.0 * (double(pixel.y) + 0.5) / double(camera.height);
  precise const double aspect = double(camera.width) / double(camera.height);
  // Same operations in the same order as PinholeCamera::direction: both must agree for a ray through an edge.
  precise const double across = ndc_x * aspect;
  precise const dvec3 offset = across * camera.right + ndc_y * camera.up;
  precise const dvec3 direction = camera.middle + offset * camera.tan_half_fov;

  precise const dvec3 a = dvec3(corners[3 * triangle]) - camera.eye;
  precise const dvec3 b = dvec3(corners[3 * triangle + 1]) - camera.eye;
  precise const dvec3 c = dvec3(corners[3 * triangle + 2]) - camera.eye;
  const double ab = cross_dot(direction, a, b), bc = cross_dot(direction, b, c), ac = cross_dot(direction, a, c);
  const bool one_way = ab >= 0.0 && bc >= 0.0 && ac <= 0.0, other_way = ab <= 0.0 && bc <= 0.0 && ac >= 0.0;
  if (one_way == other_way) return;  // neither orientation; or all zero: edge-on or without area
  // Edges are differences of the corners themselves, as in visibility::cover: relative to the eye they would be
  // rounded.
  precise const dvec3 corner = dvec3(corners[3 * triangle]);
  precise const dvec3 u = dvec3(corners[3 * triangle + 1]) - corner, v = dvec3(corners[3 * triangle + 2]) - corner;
  const double toward = cross_dot(direction, u, v);
  if (toward == 0.0) return;
  precise const double t = cross_dot(a, u, v) / toward;
  if (!(t > 0.0)) return;

  const uint slot = (pixel.y - camera.first_row) * camera.width + pixel.x;
  const uint64_t order = doubleBitsToUint64(t);
  if (kSecondPass == 0) {
    atomicMin(nearest[slot], order);
  } else if (nearest[slot] == order) {
    atomicMin(winner[slot], ranks[triangle]);
  }
}
