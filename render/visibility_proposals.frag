// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/both.glsl"

// OpenGL only: lists the pixels that the rasteriser proposes for each triangle, for the host to decide
// (visibility::cover). In any order: the host takes a minimum over them.

STORAGE(1) readonly buffer Push {
  double numbers[13];
  uint counts[4];  // width, height, first row, rows
};
STORAGE(2) buffer Proposals {
  uint count;    // also counts proposals that found no space
  uint found[];  // pixel of the band and triangle, alternating
};

layout(location = 0) flat in uint triangle;

void main() {
  const uint slot = atomicAdd(count, 1u);
  if (2 * slot + 1 >= uint(found.length())) return;
  found[2 * slot] = uint(gl_FragCoord.y) * counts[0] + uint(gl_FragCoord.x);
  found[2 * slot + 1] = triangle;
}
