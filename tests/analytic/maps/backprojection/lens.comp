// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/backprojection/patches/lens.glsl"

// Computes the area that two disks share, from their radii and the distance between their centres.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Disks { vec3 disks[]; };
layout(scalar, binding = 1) buffer Areas { float areas[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < disks.length()) areas[i] = lens(disks[i].x, disks[i].y, disks[i].z);
}
