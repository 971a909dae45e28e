// V of each receiver, whose texels a workgroup looks at; see group_kernel.glsl. The shader defines, too,
//   uint hidden_by(MapFace face, uvec2 cell)    how much of the light a texel hides, in parts of kWholeLight
//   float share_above()                         the share of the light above the receiver's horizon
//   Kernel next_kernel(MapFace face, uint turn) a kernel to look at after the first, on turns 1, 2 ...; empty: none
// Parts are added as integers: their order, and how many rows of the map are looked at at a time, change nothing.
shared uint sum_low, sum_high;  // sum_low + 2^15 sum_high
uint sum = 0;                   // of this invocation

void before_tiles() {}
void look_at(MapFace face, uvec2 cell) { sum = min(sum + hidden_by(face, cell), kWholeLight); }

#include "maps/host/group_tiles.glsl"

void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count || !is_asked()) return;
  const Receiver receiver = receivers[lookup.first_receiver + i];
  if (gl_LocalInvocationIndex == 0) sum_low = sum_high = 0;
  barrier();

  const bool receives = receiver.n != vec3(0.0);
  const bool reached = receives && ask(receiver);
  if (reached) {
    for (uint number = 0; number < asked.side.face_count; ++number) {
      const MapFace face = face_of(asked.side, 0, lookup.size, number);
      Kernel kernel = kernel_of(face);
      look_at_kernel(face, kernel);
      for (uint turn = 1; !is_empty(kernel); ++turn) {
        kernel = next_kernel(face, turn);
        if (!is_empty(kernel)) look_at_kernel(face, kernel);
      }
    }
    if (all_hidden) sum = kWholeLight;
    atomicAdd(sum_low, sum & 32767u);
    atomicAdd(sum_high, sum >> 15);
  }
  barrier();
  check_that_loops_ended();
  if (gl_LocalInvocationIndex != 0) return;

  // Until the last rows of the map are looked at the result is what is left of the light, in parts.
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
