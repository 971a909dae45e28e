// SPDX-License-Identifier: Apache-2.0
// Workgroups of a look-up that has a sorting pass before it. Most receivers need no texel of the map: a pyramid shows
// at once that they see all of the light, or none of it. On a driver that runs both sides of a branch, a workgroup for
// such a receiver would cost as much as any other. So the sorting pass, with one invocation for each workgroup,
// computes V of these receivers, and lists the other workgroups. The sorting pass is the same shader with SORTS_OUT.

uint group_list() { return results.length() - kCutLoopWords - kGroupListWords; }

#ifdef SORTS_OUT
// Returns the workgroup that this invocation sorts.
uint this_group() { return group_in_turn() * gl_WorkGroupSize.x + gl_LocalInvocationID.x; }

// Lists this invocation's workgroup. The order of the list changes no result.
void list_group() {
  const uint k = atomicAdd(results[group_list()], 1);
  results[results[group_list() + 1] + lookup.first_result + k] = this_group();
}
#else
// Returns the listed workgroup; all ones beyond the list.
uint this_group() {
  const uint k = group_in_turn();
  return k < results[group_list()] ? results[results[group_list() + 1] + lookup.first_result + k] : 0xffffffffu;
}
#endif
