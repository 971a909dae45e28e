// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"

// Transforms as caster.vert does, and passes the triangle's id.

STORAGE(1) readonly buffer Ids { uint id_of[]; };
PUSH_CONSTANTS Push { CasterPush face; };
layout(location = 0) flat out uint id;

void main() {
  const vec3 d = corner_at(VERTEX) - face.point;
  const float w = dot(face.row_w, d);
  gl_Position = vec4(dot(face.row_x, d), dot(face.row_y, d), w - face.near, w);
  id = id_of[VERTEX / 3];
}
