// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/lists/penumbra_events.shared.h"

// Sorts the events of each texel, sums them to V as a function of depth, and reduces V to as few steps as the bound
// allows (Lokovic and Veach 2000 with constant pieces in place of lines: V jumps at every event, and a line would not
// stay within the bound). A piece continues while one value is within the bound of everything in the piece. V = 1 and V
// = 0 are kept exactly. In place: steps (bits of the t at which they begin, bits of V from there) overwrite events
// already read.

layout(local_size_x = kLookupGroup) in;
layout(scalar, binding = 0) buffer Events { uvec2 events[]; };
layout(scalar, binding = 1) buffer Counts { uint counts[]; };  // number of events of each texel, then of its steps
layout(scalar, binding = 2) buffer Ended { uint ended; };      // 1: a driver ended a loop early
layout(scalar, push_constant) uniform Push { CompressPush push; };

uint first;

// Heap sort by t, whose bits have the order of integers: t > 0.
void sift_down(uint root, uint count) {
  const uvec2 moved = events[first + root];
  for (;;) {
    uint child = 2 * root + 1;
    if (child >= count) break;
    if (child + 1 < count && events[first + child + 1].x > events[first + child].x) ++child;
    if (events[first + child].x <= moved.x) break;
    events[first + root] = events[first + child];
    root = child;
  }
  events[first + root] = moved;
}

void sort(uint count) {
  for (uint i = count / 2; i-- > 0;) sift_down(i, count);
  for (uint end = count; end-- > 1;) {
    const uvec2 largest = events[first];
    events[first] = events[first + end];
    events[first + end] = largest;
    sift_down(0, end);
  }
}

// Returns whether one value is within the bound of all values from `low` to `high`; `value` is twice the weight of this
// value.
bool one_value(uint low, uint high, out uint value) {
  if (high == push.total) {
    value = 2 * push.total;
    return 2 * (high - low) <= push.tolerance;
  }
  if (low == 0) {
    value = 0;
    return 2 * high <= push.tolerance;
  }
  value = low + high;
  return high - low <= push.tolerance;
}

void main() {
  const uint texel = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (texel >= push.texel_count) return;
  first = texel * push.capacity;
  const uint count = counts[texel];
  sort(count);

  uint visible = push.total, steps = 0;
  uint low = visible, high = visible, value = 2 * visible, begin = 0;  // of the current piece
  bool is_first = true;                                                // V = 1 from the light on needs no step
  uint i = 0;
  for (; i < count;) {
    const uint t = events[first + i].x;
    for (; i < count && events[first + i].x == t; ++i) {
      const uint event = events[first + i].y, weight = event & 0x7fffffffu;
      visible = (event & 0x80000000u) != 0 ? visible - weight : visible + weight;
    }
    uint joined;
    if (one_value(min(low, visible), max(high, visible), joined)) {
      low = min(low, visible);
      high = max(high, visible);
      value = joined;
      continue;
    }
    if (!is_first) events[first + steps++] = uvec2(begin, floatBitsToUint(float(value) / float(2 * push.total)));
    is_first = false;
    begin = t;
    low = high = visible;
    one_value(visible, visible, value);
  }
  if (!is_first) events[first + steps++] = uvec2(begin, floatBitsToUint(float(value) / float(2 * push.total)));
  counts[texel] = steps;
  if (i < count) ended = 1;
}
