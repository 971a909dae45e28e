// SPDX-License-Identifier: Apache-2.0
// Computes V of each receiver, whose texels are processed by a workgroup; see group_kernel.glsl. The shader also
// defines
//   uint hidden_by(MapFace face, uvec2 cell)    part of the light hidden by a texel, in units of 1 / kWholeLight
//   float share_above()                         fraction of the light above the receiver's horizon
//   Kernel next_kernel(MapFace face, uint turn) a kernel after the first, on turns 1, 2 ...; empty: none
// Parts are added as integers: the result does not depend on their order, nor on the number of rows of the map
// processed at a time.
#ifdef SORTS_OUT
#include "maps/host/group_sort_main.glsl"
#else
shared uint sum_low, sum_high;  // sum_low + 2^15 sum_high
uint sum = 0;                   // sum of this invocation

void before_tiles() {}
void look_at(MapFace face, uvec2 cell) { sum = min(sum + hidden_by(face, cell), kWholeLight); }

#include "maps/host/group_tiles.glsl"
#include "maps/host/group_faces.glsl"

void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count || !is_asked()) return;
  const Receiver receiver = receivers[lookup.first_receiver + i];
  if (gl_LocalInvocationIndex == 0) sum_low = sum_high = 0;
  barrier();

  const bool receives = receiver.n != vec3(0.0);
  const bool reached = receives && ask(receiver);
  if (reached) {
    look_at_faces();
    if (all_hidden) sum = kWholeLight;
    atomicAdd(sum_low, sum & 32767u);
    atomicAdd(sum_high, sum >> 15);
  }
  barrier();
  check_that_loops_ended();
  if (gl_LocalInvocationIndex != 0) return;

  // Until the last rows of the map are processed, the result is the remaining part of the light, in units of 1 /
  // kWholeLight.
  const uint result = lookup.first_result + i;
  const uint whole = kWholeLight >> 15;
  const uint high = min(sum_high + (sum_low >> 15), whole);
  const uint hidden = high == whole ? kWholeLight : (high << 15) + (sum_low & 32767u);
  uint left = lookup.first_row == 0 ? kWholeLight : results[result];
  left -= min(left, hidden);
  if (lookup.last_row + 1 < lookup.size) {
    results[result] = left;
    return;
  }
  float v = 1.0;
  if (receives) v = reached ? visible_above(float(left) / float(kWholeLight), share_above()) : 0.0;
  results[result] = floatBitsToUint(v);
}
#endif
