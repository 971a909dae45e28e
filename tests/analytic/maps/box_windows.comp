// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/look_up.glsl"
#define PREFILTER_FIRST 4
#include "maps/products/prefilter.glsl"

// Computes the light's box as receivers see it on a map, in texels. Requests are passed as receivers: p is the receiver, n.xy half the box's sides,
// n.z the height through which it is seen.
void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count) return;
  const Receiver asked = receivers[i];
  const Box box = box_through(views[0], asked.p, asked.n.xy, asked.n.z);
  results[5 * i] = box.face;
  results[5 * i + 1] = floatBitsToUint(box.lower.x);
  results[5 * i + 2] = floatBitsToUint(box.lower.y);
  results[5 * i + 3] = floatBitsToUint(box.upper.x);
  results[5 * i + 4] = floatBitsToUint(box.upper.y);
}
