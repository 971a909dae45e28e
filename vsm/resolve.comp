// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "vsm/view_sample.shared.h"

// Last pass of view-sample mapping: counts the light samples that each pixel sees.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Masks { uint masks[]; };
layout(scalar, binding = 1) writeonly buffer Counts { uint counts[]; };
layout(scalar, push_constant) uniform Push { ResolvePush push; };

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.pixel_count) return;
  const uint words = (push.sample_count + 31) / 32;
  uint count = 0;
  for (uint word = 0; word < words; ++word) count += bitCount(masks[i * words + word]);
  counts[i] = count;
}
