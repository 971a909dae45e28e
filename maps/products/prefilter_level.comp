// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/prefilter.shared.h"

// Computes one level of a mip pyramid (Williams 1983) or of an N-buffer of means (Décoret 2005; Eisemann and Décoret
// 2006) from the previous level: each texel is the mean of four, in a fixed order. One invocation for each texel of one
// block.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) buffer Images { float images[]; };
layout(scalar, push_constant) uniform Push { PrefilterLevelPush push; };

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x +
                 gl_LocalInvocationID.x;
  const bool pyramid = push.scheme == kPyramid;
  // A pyramid's sizes are halved and rounded up, so that each size can be computed from the first.
  const uint before = pyramid ? (push.size + (1u << (push.level - 1)) - 1) >> (push.level - 1) : push.size;
  const uint size = pyramid ? (before + 1) / 2 : push.size;
  const uint texels = push.faces * size * size;
  if (i >= texels * push.blocks) return;
  const uint block = i / texels * push.block, texel = i % texels;
  const uint x = texel % size, y = texel / size % size, face = texel / (size * size);
  const uint source = block + push.from + face * before * before;
  // Beyond the border a pyramid has no texels: the mean is that of the existing ones. Windows of an N-buffer that
  // extend beyond the border are never used.
  const uint step = pyramid ? 1 : 1u << (push.level - 1);
  const uint x0 = pyramid ? 2 * x : x, y0 = pyramid ? 2 * y : y;
  const uint x1 = min(x0 + step, before - 1), y1 = min(y0 + step, before - 1);
  const float upper = images[source + y0 * before + x0] + images[source + y0 * before + x1];
  const float lower = images[source + y1 * before + x0] + images[source + y1 * before + x1];
  images[block + push.to + texel] = 0.25 * (upper + lower);
}
