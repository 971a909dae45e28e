#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "vsm/view_sample.shared.h"

// Puts the exact answers into the masks: each is a word and the bits to set in it.

layout(local_size_x = 64) in;
struct Answer {
  uint word, bits;
};
layout(scalar, binding = 0) buffer Masks { uint masks[]; };
layout(scalar, binding = 1) readonly buffer Answers { Answer answers[]; };
layout(scalar, push_constant) uniform Push { uint answer_count; };

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i < answer_count) atomicOr(masks[answers[i].word], answers[i].bits);
}
