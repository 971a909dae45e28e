// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"
#include "maps/host/holes.glsl"
#include "maps/host/map_depth.glsl"

// Draws as caster.frag does, for surfaces with holes: a texel whose centre is in a hole keeps the surface behind.

PUSH_CONSTANTS HolesBlock { CasterPush push; };

void main() {
  if (is_hole()) discard;
  gl_FragDepth = offset_map_depth(push, gl_FragCoord);
}
