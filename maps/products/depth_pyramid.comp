// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/depth_pyramid.shared.h"

// Computes one level of a pyramid of smallest and largest depths: cells from texels, nodes from four nodes of the level
// below. A node that extends beyond the last cell has the range of the existing cells.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 1) buffer Pyramid {
  PyramidHeader header;
  vec2 nodes[];
};
layout(scalar, push_constant) uniform Push { PyramidPush push; };

const float kEmpty = 1.0;  // depth of empty texels

void main() {
  const uint side = pyramid_nodes(push.cells, push.shift);
  const uint index =
      (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (index >= push.faces * side * side) return;
  const uint face = index / (side * side);
  const uvec2 at = uvec2(index % side, index / side % side);

  vec2 range = vec2(kEmpty, 0.0);
  for (uint k = 0; k < 4; ++k) {
    const uvec2 child = uvec2(k & 1, k >> 1);
    if (push.level == 0) {
      const uint size = push.cells - 1;
      const uvec2 texel = at + child - 1;  // for cell 0 and beyond the last cell: outside the map
      const bool inside = texel.x < size && texel.y < size;
      const float depth = inside ? maps[(face * size + texel.y) * size + texel.x] : kEmpty;
      range = vec2(min(range.x, depth), max(range.y, depth));
    } else {
      const uint below = pyramid_nodes(push.cells, push.shift_below);
      const uvec2 node = (at << (push.shift - push.shift_below)) + (child << (push.level - 1 - push.shift_below));
      if (node.x >= below || node.y >= below) continue;
      const vec2 part = nodes[push.first_below + (face * below + node.y) * below + node.x];
      range = vec2(min(range.x, part.x), max(range.y, part.y));
    }
  }
  nodes[push.first + index] = range;
}
