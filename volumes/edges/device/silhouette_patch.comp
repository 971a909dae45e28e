// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "volumes/edges/device/facing.shared.h"
#include "volumes/edges/device/silhouette.shared.h"

// Writes the facings that the host decided. Each triangle is on the list once, in any order.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Counted { uint counted[]; };
layout(scalar, binding = 1) writeonly buffer Sides { uint sides[]; };
layout(scalar, binding = 2) readonly buffer Open {
  uint open_count;
  OpenFacing open[];
};
layout(scalar, push_constant) uniform Push { uint count; };

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= count) return;
  const uint triangle = open[i].triangle, side = open[i].side;
  sides[triangle] = side | (side & counted[triangle]) << kCountedShift;
}
