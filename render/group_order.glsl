// SPDX-License-Identifier: Apache-2.0
// Numbers a dispatch's workgroups so that threads of a processor have equal work. Mesa's driver for processors gives
// each thread one consecutive part of a dispatch's workgroups; numbered in the order of launch, one thread would have
// the costly part of a picture while the others wait. On such drivers, strips of the picture take turns. A GPU's
// workgroups keep the order of launch, in which neighbours share caches: kStrips is 1.
#include "render/group_order.shared.h"

layout(constant_id = kStripsConstant) const uint kStrips = 1;

// Returns the number of this workgroup among those of its dispatch; each number once.
uint group_in_turn() {
  const uint launched = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint length = gl_NumWorkGroups.x * gl_NumWorkGroups.y / kStrips;  // of a strip; other groups keep their number
  return launched < length * kStrips ? launched % kStrips * length + launched / kStrips : launched;
}
