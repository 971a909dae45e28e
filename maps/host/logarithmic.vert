// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"

// Draws each triangle as a bounding rectangle (six vertices), for faces with logarithmic rows, where edges are curves
// that no rasteriser draws; logarithmic.frag decides (Lloyd et al. 2007). Rows grow with b, and b is largest at a
// corner. In a paraboloid's circle edges are arcs; there the cap that contains a triangle's corners contains the
// triangle, and caps are disks.

PUSH_CONSTANTS Push { LogarithmicPush push; };
layout(location = 0) flat out uint first_corner;

// Bounds the disk of a cap of half angle `around` about the direction c: an angle from the paraboloid's axis is
// projected to the tangent of half the angle.
void bound_circle(out vec2 lower, out vec2 upper) {
  lower = vec2(0.0);
  upper = vec2(1.0);
  vec3 directions[3], middle = vec3(0.0);
  for (uint i = 0; i < 3; ++i) {
    const vec3 d = corner_at(first_corner + i) - push.point;
    directions[i] = normalize(vec3(dot(push.row_a, d), dot(push.row_b, d), dot(push.row_k, d)));
    middle += directions[i];
  }
  if (!(length(middle) > 1.0e-3)) return;
  middle = normalize(middle);
  float around = 0.0;
  for (uint i = 0; i < 3; ++i) around = max(around, acos(clamp(dot(middle, directions[i]), -1.0, 1.0)));
  const float half_turn = 3.14159265, off = acos(clamp(middle.z, -1.0, 1.0));
  if (!(around < 0.49 * half_turn) || !(off + around < 0.98 * half_turn)) return;
  const float least = tan(0.5 * (off - around)), most = tan(0.5 * (off + around));
  const float across = length(middle.xy);
  const vec2 towards = across > 0.0 ? middle.xy / across : vec2(1.0, 0.0);
  const vec2 at = 0.5 + (0.5 - push.margin) * 0.5 * (least + most) * towards;
  const float wide = (0.5 - push.margin) * 0.5 * (most - least);
  lower = at - wide;
  upper = at + wide;
}

void bound_logarithms(out vec2 lower, out vec2 upper) {
  lower = vec2(1.0);
  upper = vec2(0.0);
  for (uint i = 0; i < 3; ++i) {
    const vec3 d = corner_at(first_corner + i) - push.point;
    const float k = dot(push.row_k, d), b = dot(push.row_b, d) / k, left = 1.0 - b * (1.0 - 1.0 / push.ratio);
    if (!(k > 0.0 && left > 0.0)) {  // the triangle may be seen anywhere
      lower = vec2(0.0);
      upper = vec2(1.0);
      break;
    }
    const vec2 at = vec2(dot(push.row_a, d) / k, push.margin - (1.0 - 2.0 * push.margin) * log(left) / log(push.ratio));
    lower = min(lower, at);
    upper = max(upper, at);
  }
}

void main() {
  first_corner = push.first_vertex + VERTEX / 6 * 3;
  vec2 lower, upper;
  if (push.ratio == kCircle) {
    bound_circle(lower, upper);
  } else {
    bound_logarithms(lower, upper);
  }
  // One texel wider on every side, for rounding.
  lower -= 1.0 / float(push.size);
  upper += 1.0 / float(push.size);
  const uint corner = VERTEX % 6;
  const vec2 share = vec2(corner == 1 || corner == 3 || corner == 4 ? 1.0 : 0.0, corner == 2 || corner == 4 || corner == 5 ? 1.0 : 0.0);
  gl_Position = vec4(2.0 * clamp(mix(lower, upper, share), vec2(0.0), vec2(1.0)) - 1.0, 0.0, 1.0);
}
