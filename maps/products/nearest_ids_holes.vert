// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/nearest_ids.shared.h"
#include "render/both.glsl"
#include "maps/host/holes_corner.glsl"

// Transforms as nearest_ids.vert does, for surfaces with holes.

STORAGE(2) readonly buffer Surfaces { uint surface_words[]; };  // read by the fragment shader
STORAGE(3) readonly buffer Ids { uint id_of[]; };
PUSH_CONSTANTS Push { CasterPush face; };
layout(location = 0) flat out uint id;

void main() {
  const vec3 d = corner_at(VERTEX) - face.point;
  const float w = dot(face.row_w, d);
  gl_Position = vec4(dot(face.row_x, d), dot(face.row_y, d), w - face.near, w);
  id = id_of[VERTEX / 3];
  place_corner(VERTEX);
}
