// SPDX-License-Identifier: Apache-2.0
// Queries of a DepthPyramid. Includers define PYRAMID_BINDING first, the binding of its buffer.
#include "maps/products/depth_pyramid.shared.h"

layout(scalar, binding = PYRAMID_BINDING) readonly buffer Pyramid {
  PyramidHeader header;
  vec2 nodes[];
} pyramid;

// Returns the smallest and the largest depth of the node at this cell: stored depths, 1 for empty texels.
vec2 pyramid_node(uint level, uint face, uvec2 cell) {
  const uint shift = pyramid_shift(level, pyramid.header.whole);
  const uint side = pyramid_nodes(pyramid.header.cells, shift);
  const uvec2 node = cell >> shift;
  return pyramid.nodes[pyramid.header.first[level] + (face * side + node.y) * side + node.x];
}

// Returns a range that contains the range of the cells lower … upper; the exact range in an MSSM.
vec2 depth_range_of_cells(uint face, uvec2 lower, uvec2 upper) {
  const PyramidQuery query = pyramid_query(lower, upper, pyramid.header.whole, pyramid.header.top);
  const uvec2 count = (query.to - query.from) / query.step + 1;
  // One loop: if invocations leave two nested loops at different iterations, Mesa 22.3 on processors loses some
  // iterations.
  vec2 range = vec2(1.0, 0.0);
  for (uint k = 0; k < count.x * count.y; ++k) {
    const uvec2 node = min(query.from + uvec2(k % count.x, k / count.x) * query.step, query.to + 1 - query.step);
    const vec2 part = pyramid_node(query.level, face, node << query.shift);
    range = vec2(min(range.x, part.x), max(range.y, part.y));
  }
  return range;
}

// Returns a range that contains the range of the texels lower … upper; the exact range in an MSSM if there are two or
// more texels a side.
vec2 depth_range(uint face, uvec2 lower, uvec2 upper) {
  return depth_range_of_cells(face, lower + 1, max(upper, lower + 1));
}
