// SPDX-License-Identifier: Apache-2.0
// Depth peeling (Everitt 2001): fragments not behind the previous layer are discarded. Depth as in caster.frag; a
// surface within 2^-20 of the previous layer is the same surface. `maps` is declared by the shader.

PUSH_CONSTANTS Peel { PeelPush push; };  // not Push: blocks with one name are one block in both stages

void peel() {
  const float depth = map_depth(push.face, gl_FragCoord);
  const uvec2 cell = uvec2(gl_FragCoord.xy);
  if (!(depth > maps[push.previous + cell.y * push.size + cell.x] * (1.0 + 1.0 / 1048576.0))) discard;
  gl_FragDepth = depth;
}
