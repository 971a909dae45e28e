// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
uint fetches = 0;
#define PREFILTER_FETCHES ++fetches
#include "maps/host/look_up.glsl"
#define PREFILTER_FIRST 4
#include "maps/products/prefilter.glsl"

// Computes means of the function `first_point` over boxes of one face, and how many words each took. Boxes are passed as receivers: from p.xy to
// n.xy; the share p.z is in the map.
void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count) return;
  const Receiver box = receivers[i];
  results[2 * i] = floatBitsToUint(mean_over(lookup.first_point, Box(0, box.p.xy, box.n.xy, box.p.z), 0.0));
  results[2 * i + 1] = fetches;
}
