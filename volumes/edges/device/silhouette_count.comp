// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "volumes/edges/device/facing.shared.h"
#include "volumes/edges/device/silhouette.shared.h"

// Computes k_e of every edge (mesh/silhouettes.hpp), and the number of non-zero ones in each block of edges.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Pairs { uvec2 pairs[]; };  // for every edge: see silhouette.shared.h
layout(scalar, binding = 1) readonly buffer First { uint first[]; };   // list of the edges with more than two
                                                                       // triangles, in CSR format
layout(scalar, binding = 2) readonly buffer More { uint more[]; };
layout(scalar, binding = 3) readonly buffer Sides { uint sides[]; };
layout(scalar, binding = 4) writeonly buffer Multiplicities { int multiplicities[]; };
layout(scalar, binding = 5) buffer Blocks { uint blocks[]; };
layout(scalar, push_constant) uniform Push { uint edge_count; };

int sign_of(uint incidence) {
  const uint side = sides[incidence / 2] >> kCountedShift;
  const int sign = int(side & 1) - int(side >> 1);
  return (incidence & 1) != 0 ? -sign : sign;
}

void main() {
  const uint edge =
      (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (edge >= edge_count) return;
  const uvec2 pair = pairs[edge];
  int k = 0;
  if ((pair.x & kManyIncidences) == 0) {
    k = sign_of(pair.x) + sign_of(pair.y);
  } else {
    const uint many = pair.x & ~kManyIncidences, last = first[many + 1];
    for (uint i = first[many]; i < last; ++i) k += sign_of(more[i]);
  }
  multiplicities[edge] = k;
  if (k != 0) atomicAdd(blocks[edge / kEdgesPerBlock], 1);
}
