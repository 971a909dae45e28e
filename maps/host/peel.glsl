// A deeper layer: what is not behind the layer before leaves no depth (Everitt 2001, depth peeling). Depth as in
// caster.frag; what is within 2^-20 of the layer before is the same surface. `maps` is the shader's.

PUSH_CONSTANTS Peel { PeelPush push; };  // not Push: blocks of one name are one in both stages

void peel() {
  const float depth = map_depth(push.face, gl_FragCoord);
  const uvec2 cell = uvec2(gl_FragCoord.xy);
  if (!(depth > maps[push.previous + cell.y * push.size + cell.x] * (1.0 + 1.0 / 1048576.0))) discard;
  gl_FragDepth = depth;
}
