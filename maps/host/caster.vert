// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"

// Draws one face of a light point's maps (Williams 1978). clip.z = w - near clips at the near plane and nowhere else,
// before the division by w, so that a triangle which crosses the light's plane keeps its front part; the fragment
// shader computes depth.

PUSH_CONSTANTS Push { CasterPush face; };

void main() {
  const vec3 d = corner_at(face.first_vertex + VERTEX) - face.point;
  const float w = dot(face.row_w, d);
  gl_Position = vec4(dot(face.row_x, d), dot(face.row_y, d), w - face.near, w);
}
