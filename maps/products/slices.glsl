// SPDX-License-Identifier: Apache-2.0
// Marks the slice that contains a surface at a texel's centre (Eisemann and Décoret 2006). A texel may have any number
// of surfaces: their bits are added in any order. `planes` and `bits` are declared by the shader.

PUSH_CONSTANTS SlicePush { SlicesPush push; };

void mark_slice() {
  const uvec2 at = uvec2(gl_FragCoord.xy);
  const float along = 1.0 / gl_FragCoord.w;
  const float height = push.sideways != 0 ? along * gl_FragCoord.y / float(push.size) : along;
  for (uint k = 0; k < planes.count; ++k) {
    if (height > planes.limit[push.side][k]) continue;
    atomicOr(bits[push.first + at.y * push.size + at.x], 1u << k);
    return;
  }
}
