// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/lists/layered_depth.shared.h"

// Merges the nodes of one light sample's map into a texel's layers, nearest first (Agrawala et al. 2000). A depth
// within epsilon of a layer, plus the change of the surface's depth within the texel, belongs to this layer, and counts
// once for each sample; any other depth begins a new layer. Of two nodes at one depth the larger reach counts,
// independent of their order.

layout(local_size_x = kLookupGroup) in;
layout(scalar, binding = 0) readonly buffer Heads { uint heads[]; };
layout(scalar, binding = 1) readonly buffer Nodes { LayerNode nodes[]; };
layout(scalar, binding = 2) readonly buffer Weights { uint weights[]; };
layout(scalar, binding = 3) buffer Counts { uint counts[]; };
layout(scalar, binding = 4) buffer Entries { LayerEntry entries[]; };  // a texel's entries are contiguous
layout(scalar, binding = 5) buffer Most { uint most; };                // largest number of layers needed by a texel
layout(scalar, push_constant) uniform Push { MergePush push; };

void main() {
  const uint texel = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (texel >= push.texels || heads[texel] == 0) return;
  const uint first = texel * push.layers;
  uint count = counts[texel], done = 0;  // bits of the most recently merged depth; depths are positive
  for (;;) {
    uint next = 0xffffffffu;  // the smallest depth beyond `done`
    float reach = 0.0;
    for (uint node = heads[texel]; node != 0; node = nodes[node - 1].before) {
      const LayerNode found = nodes[node - 1];
      if (found.t <= done || found.t > next) continue;
      reach = found.t == next ? max(reach, found.reach) : found.reach;
      next = found.t;
    }
    if (next == 0xffffffffu) break;
    done = next;
    const float t = uintBitsToFloat(next);
    uint nearest = count;
    float off = 0.0;
    for (uint e = 0; e < count; ++e) {
      const float from = abs(entries[first + e].t - t);
      if (from > push.epsilon * t + max(reach, entries[first + e].reach)) continue;
      if (nearest < count && from >= off) continue;
      nearest = e;
      off = from;
    }
    if (nearest == count) {
      if (count == push.layers) {
        atomicMax(most, count + 1);
        continue;
      }
      entries[first + count++] = LayerEntry(t, reach, weights[push.point], push.point + 1);
    } else if (entries[first + nearest].last != push.point + 1) {
      entries[first + nearest].weight += weights[push.point];
      entries[first + nearest].last = push.point + 1;
    }
  }
  counts[texel] = count;
}
