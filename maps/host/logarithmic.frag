// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"

// Intersects the ray through a texel's centre with the triangle and returns the distance along the face's axis. Used
// for faces with logarithmic rows, and for a paraboloid's circle, for which inverse_a, inverse_b and inverse_1 are the
// face's axes.

STORAGE(1) readonly buffer Maps { float maps[]; };
PUSH_CONSTANTS Log { LogarithmicPush push; };  // not Push: blocks with one name are one block in both stages
layout(location = 0) flat in uint first_corner;

vec3 direction_of(vec2 place) {
  if (push.ratio == kCircle) {
    const vec2 at = (place - 0.5) / (0.5 - push.margin);
    return push.inverse_a * (2.0 * at.x) + push.inverse_b * (2.0 * at.y) + push.inverse_1 * (1.0 - dot(at, at));
  }
  const float power = (place.y - push.margin) / (1.0 - 2.0 * push.margin);
  const float b = (1.0 - exp(-power * log(push.ratio))) / (1.0 - 1.0 / push.ratio);
  return push.inverse_a * place.x + push.inverse_b * b + push.inverse_1;
}

void main() {
  const vec3 direction = direction_of(gl_FragCoord.xy / float(push.size));
  const float along = dot(push.along, direction);
  const vec3 p = corner_at(first_corner) - push.point, q = corner_at(first_corner + 1) - push.point,
             r = corner_at(first_corner + 2) - push.point;
  const vec3 normal = cross(q - p, r - p);
  const vec3 sides = vec3(dot(direction, cross(p, q)), dot(direction, cross(q, r)), dot(direction, cross(r, p)));
  const bool inside = all(greaterThanEqual(sides, vec3(0.0))) || all(lessThanEqual(sides, vec3(0.0)));
  const float depth = dot(normal, p) / dot(normal, direction) * along / push.far;
  if (!(along > 0.0 && inside && depth > 1.0 / 1048576.0 && depth < 1.0)) discard;
  if (push.peels != 0) {
    const uvec2 cell = uvec2(gl_FragCoord.xy);
    if (!(depth > maps[push.previous + cell.y * push.size + cell.x] * (1.0 + 1.0 / 1048576.0))) discard;
  }
  gl_FragDepth = depth;
}
