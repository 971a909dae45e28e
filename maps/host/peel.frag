#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"

// A deeper layer: what is not behind the layer before leaves no depth (Everitt 2001, depth peeling). Depth as in
// caster.frag; what is within 2^-20 of the layer before is the same surface.

STORAGE(1) readonly buffer Maps { float maps[]; };
PUSH_CONSTANTS Peel { PeelPush push; };  // not Push: blocks of one name are one in both stages

void main() {
  const float depth = map_depth(push.face, gl_FragCoord);
  const uvec2 cell = uvec2(gl_FragCoord.xy);
  if (!(depth > maps[push.previous + cell.y * push.size + cell.x] * (1.0 + 1.0 / 1048576.0))) discard;
  gl_FragDepth = depth;
}
