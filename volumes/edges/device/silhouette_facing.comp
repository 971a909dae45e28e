// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "volumes/edges/device/facing.shared.h"
#include "volumes/edges/device/silhouette.shared.h"

// Computes the side of every triangle that one point is on, one lane for each triangle. A sign is used only if it
// exceeds its error bound (volumes/README.md, Bounds). A triangle whose sign is within the bound gets both bits and is
// listed for the host. Has no branches.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Triangles { FacingTriangle triangles[]; };
layout(scalar, binding = 1) readonly buffer Counted { uint counted[]; };
layout(scalar, binding = 2) writeonly buffer Sides { uint sides[]; };
layout(scalar, binding = 3) buffer Open {
  uint open_count;
  OpenFacing open[];  // space for every triangle
};
layout(scalar, push_constant) uniform Push { SilhouetteFacingPush push; };

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.triangle_count) return;
  const FacingTriangle t = triangles[i];
  precise const vec3 g = push.light.p - t.a;
  precise const vec3 size = abs(g);
  precise const float h = t.n.x * g.x + t.n.y * g.y + t.n.z * g.z;
  precise const float e = t.slack.x * size.x + t.slack.y * size.y + t.slack.z * size.z + push.light.slack;
  const uint side = (h > -e ? kFrontBit : 0u) | (h < e ? kBackBit : 0u);
  if (side == kBothBits) open[atomicAdd(open_count, 1)].triangle = i;
  sides[i] = side | (side & counted[i]) << kCountedShift;
}
