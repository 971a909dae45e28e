// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Writes the host's exact decisions into the masks of visible light samples, and updates the counts of visible samples.
#include "engines/device/mask.shared.h"

// Several of the host's words may concern one word of a mask: they decide different bits, or agree on a bit.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) buffer Masks { uint masks[]; };
layout(scalar, binding = 1) buffer Counts { uint counts[]; };
layout(scalar, binding = 2) readonly buffer Words { MaskWord words[]; };
layout(scalar, push_constant) uniform Push { uint word_count; };

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= word_count) return;
  const MaskWord word = words[i];
  if ((word.pixel & kWholePixel) != 0) {
    masks[word.word] = word.bits;
    atomicAdd(counts[word.pixel & ~kWholePixel], uint(bitCount(word.bits)));
    return;
  }
  const uint off = word.decided & ~word.bits, was = atomicAnd(masks[word.word], ~off);
  const uint before = atomicOr(masks[word.word], word.bits);
  atomicAdd(counts[word.pixel], uint(bitCount(word.bits & ~before) - bitCount(was & off)));
}
