#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "volumes/edges/edge_scatter.shared.h"

// Puts the mask words that the host decided in their places, and counts what that changes.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) buffer Masks { uint masks[]; };
layout(scalar, binding = 1) buffer Counts { uint counts[]; };
layout(scalar, binding = 2) readonly buffer Words { MaskWord words[]; };
layout(scalar, push_constant) uniform Push { uint word_count; };

void main() {
  const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  if (i >= word_count) return;
  const MaskWord word = words[i];
  const uint old = (word.pixel & kWholePixel) != 0 ? 0 : masks[word.word], bits = (old & ~word.decided) | word.bits;
  masks[word.word] = bits;
  atomicAdd(counts[word.pixel & ~kWholePixel], uint(bitCount(bits) - bitCount(old)));
}
