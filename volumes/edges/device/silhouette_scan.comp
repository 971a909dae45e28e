// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "volumes/edges/device/facing.shared.h"
#include "volumes/edges/device/silhouette.shared.h"

// Converts the blocks' counts to places: each place is the sum of the counts before it. The total follows the last one.
// One workgroup.

layout(local_size_x = kScanLanes) in;
layout(scalar, binding = 0) buffer Blocks { uint blocks[]; };  // one more entry than there are blocks
layout(scalar, push_constant) uniform Push { uint block_count; };

shared uint sums[kScanLanes];

void main() {
  const uint lane = gl_LocalInvocationID.x;
  const uint stretch = (block_count + kScanLanes - 1) / kScanLanes;
  const uint begin = min(lane * stretch, block_count), end = min(begin + stretch, block_count);
  uint sum = 0;
  for (uint i = begin; i < end; ++i) sum += blocks[i];
  sums[lane] = sum;
  barrier();
  if (lane == 0) {
    uint before = 0;
    for (uint i = 0; i < kScanLanes; ++i) {
      const uint own = sums[i];
      sums[i] = before;
      before += own;
    }
    blocks[block_count] = before;
  }
  barrier();
  uint at = sums[lane];
  for (uint i = begin; i < end; ++i) {
    const uint own = blocks[i];
    blocks[i] = at;
    at += own;
  }
}
