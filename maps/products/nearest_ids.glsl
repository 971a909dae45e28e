// The triangles whose depth a map has at a texel (Hourcade and Nicolas 1985): of several at one place the smallest id, in
// whatever order they are drawn. Depth as in caster.frag; as in peel.frag what is within 2^-20 of the nearest is the same
// surface. `maps` and `nearest` are the
// shader's.

PUSH_CONSTANTS IdsBlock { IdsPush push; };  // not Push: blocks of one name are one in both stages
layout(location = 0) flat in uint id;

void mark_nearest() {
  const float depth = 1.0 / (gl_FragCoord.w * push.face.far);
  const uvec2 cell = uvec2(gl_FragCoord.xy);
  const uint texel = push.first + cell.y * push.size + cell.x;
  if (depth <= maps[texel] * (1.0 + 1.0 / 1048576.0)) atomicMin(nearest[texel], id);
}
