#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"
#include "maps/host/holes.glsl"
#include "maps/host/map_depth.glsl"

// caster.frag for surfaces with holes: a texel whose centre sees through one keeps what is behind.

PUSH_CONSTANTS HolesBlock { CasterPush push; };

void main() {
  if (is_hole()) discard;
  gl_FragDepth = offset_map_depth(push, gl_FragCoord);
}
