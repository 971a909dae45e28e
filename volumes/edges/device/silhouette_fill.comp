// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "volumes/edges/device/facing.shared.h"
#include "volumes/edges/device/silhouette.shared.h"

// Writes the silhouettes of each block of edges, beginning at the block's place: in the order of edges, independent of
// the device's schedule.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Multiplicities { int multiplicities[]; };
layout(scalar, binding = 1) readonly buffer Blocks { uint blocks[]; };
layout(scalar, binding = 2) writeonly buffer Silhouettes { Silhouette silhouettes[]; };
layout(scalar, push_constant) uniform Push { uint edge_count; };

void main() {
  const uint block =
      (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  const uint begin = block * kEdgesPerBlock;
  if (begin >= edge_count) return;
  uint at = blocks[block];
  if (blocks[block + 1] == at) return;
  const uint end = min(begin + kEdgesPerBlock, edge_count);
  for (uint edge = begin; edge < end; ++edge) {
    const int k = multiplicities[edge];
    if (k != 0) silhouettes[at++] = Silhouette(edge, k);
  }
}
