// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"
#include "maps/host/holes_corner.glsl"

// Draws as caster.vert does, for surfaces with holes.

PUSH_CONSTANTS Push { CasterPush face; };

void main() {
  const vec3 d = corner_at(face.first_vertex + VERTEX) - face.point;
  const float w = dot(face.row_w, d);
  gl_Position = vec4(dot(face.row_x, d), dot(face.row_y, d), w - face.near, w);
  place_corner(face.first_vertex + VERTEX);
}
