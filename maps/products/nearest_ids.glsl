// SPDX-License-Identifier: Apache-2.0
// Stores the triangle at the map's depth in a texel (Hourcade and Nicolas 1985): if there are several at one depth, the
// one with the smallest id, independent of the order of drawing. Depth as in caster.frag; as in peel.frag, surfaces
// within 2^-20 of the nearest are the same surface. `maps` and `nearest` are declared by the shader.

PUSH_CONSTANTS IdsBlock { IdsPush push; };  // not Push: blocks with one name are one block in both stages
layout(location = 0) flat in uint id;

void mark_nearest() {
  const float depth = 1.0 / (gl_FragCoord.w * push.face.far);
  const uvec2 cell = uvec2(gl_FragCoord.xy);
  const uint texel = push.first + cell.y * push.size + cell.x;
  if (depth <= maps[texel] * (1.0 + 1.0 / 1048576.0)) atomicMin(nearest[texel], id);
}
