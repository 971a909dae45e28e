#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "volumes/facing.shared.h"
#include "volumes/silhouette.shared.h"

// k_e of every edge (mesh/silhouettes.hpp), and how many of each block of edges are not 0.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer First { uint first[]; };             // CSR: one more than edges
layout(scalar, binding = 1) readonly buffer Incidences { uint incidences[]; };  // triangle · 2, + 1 if reversed
layout(scalar, binding = 2) readonly buffer Sides { uint sides[]; };
layout(scalar, binding = 3) writeonly buffer Multiplicities { int multiplicities[]; };
layout(scalar, binding = 4) buffer Blocks { uint blocks[]; };
layout(scalar, push_constant) uniform Push { uint edge_count; };

void main() {
  const uint edge =
      (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (edge >= edge_count) return;
  const uint last = first[edge + 1];
  int k = 0;
  for (uint i = first[edge]; i < last; ++i) {
    const uint incidence = incidences[i];
    const uint side = sides[incidence / 2] >> kCountedShift;
    const int sign = int(side & 1) - int(side >> 1);
    k += (incidence & 1) != 0 ? -sign : sign;
  }
  multiplicities[edge] = k;
  if (k != 0) atomicAdd(blocks[edge / kEdgesPerBlock], 1);
}
