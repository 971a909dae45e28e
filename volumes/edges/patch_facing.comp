#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "volumes/edges/facing.shared.h"

// Puts the words that the host decided back into the bit planes. Each word is on the list once, in any order.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) writeonly buffer Front { uint front[]; };
layout(scalar, binding = 1) writeonly buffer Back { uint back[]; };
layout(scalar, binding = 2) readonly buffer Decided {
  uint decided_count;
  UndecidedWord decided[];
};
layout(scalar, push_constant) uniform Push { uint count; };

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= count) return;
  front[decided[i].word] = decided[i].front;
  back[decided[i].word] = decided[i].back;
}
