// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/single_shadow/outer_map.shared.h"
#include "render/both.glsl"

// Draws the shapes beside a silhouette edge, in the light's basis: a sheet along the edge, and a fan around either end.
// The triangles only have to cover the penumbra; outer_map.frag decides.

PUSH_CONSTANTS Push { OuterPush drawn; };
layout(location = 0) flat out uint edge_drawn;
layout(location = 1) flat out uint part_drawn;

vec2 pair_at(uint i) { return vec2(corner_at(i / 3)[i % 3], corner_at((i + 1) / 3)[(i + 1) % 3]); }
vec3 triple_at(uint i) { return vec3(pair_at(i), corner_at((i + 2) / 3)[(i + 2) % 3]); }

// Returns a point on the line from a point of the edge along `direction`, at the largest extent of the penumbra: for
// cones, the extent of the maps.
vec3 outer_end(vec3 p, vec2 direction, float more) {
  const float reach = drawn.smoothies != 0 ? drawn.width * p.z : drawn.width * (max(drawn.far / p.z, 1.0) - 1.0);
  const float grown = drawn.smoothies != 0 ? 1.0 : max(drawn.far / p.z, 1.0);
  return vec3(p.xy * grown + direction * (reach * more), p.z * grown);
}

// Returns `direction` turned toward `end` by the fraction `share` of the angle between them.
vec2 turned(vec2 direction, vec2 end, float share) {
  const float angle = acos(clamp(dot(direction, end), -1.0, 1.0)) * share;
  const float turn = direction.x * end.y - direction.y * end.x < 0.0 ? -angle : angle;
  return vec2(direction.x * cos(turn) - direction.y * sin(turn), direction.x * sin(turn) + direction.y * cos(turn));
}

void main() {
  const uint edge = VERTEX / kOuterVertices, vertex = VERTEX % kOuterVertices;
  const uint at = edge * kOuterFloats;
  const vec3 a = triple_at(at), b = triple_at(at + 3);
  const vec2 outward = pair_at(at + 6), along = pair_at(at + 8);
  vec3 d;
  if (vertex < 6) {
    part_drawn = kSheet;
    const bool second = vertex == 1 || vertex == 2 || vertex == 4, outer = vertex == 2 || vertex == 4 || vertex == 5;
    const vec3 p = second ? b : a;
    d = outer ? outer_end(p, outward, 1.0) : p;
  } else {
    const uint corner = (vertex - 6) % 3, k = (vertex - 6) / 3 % kOuterFan + (corner == 2 ? 1 : 0);
    const bool second = vertex - 6 >= 3 * kOuterFan;
    part_drawn = second ? kSecondEnd : kFirstEnd;
    const vec3 p = second ? b : a;
    // Triangles around the circle, not in it: each touches the circle at its middle, a sixteenth of a half turn from
    // its ends.
    const vec2 direction = turned(outward, second ? along : -along, float(k) / float(kOuterFan));
    d = corner == 0 ? p : outer_end(p, direction, 1.0 / cos(3.1415927 / (2.0 * float(kOuterFan))));
  }
  edge_drawn = edge;
  const float w = dot(drawn.row_w, d);
  gl_Position = vec4(dot(drawn.row_x, d), dot(drawn.row_y, d), w - drawn.near, w);
}
