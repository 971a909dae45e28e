// Asking a DepthPyramid. Before this is included, PYRAMID_BINDING says where its buffer is.
#include "maps/products/depth_pyramid.shared.h"

layout(scalar, binding = PYRAMID_BINDING) readonly buffer Pyramid {
  PyramidHeader header;
  vec2 nodes[];
} pyramid;

// The smallest and the largest depth of a node that stands at this cell: stored depths, 1 where there is nothing.
vec2 pyramid_node(uint level, uint face, uvec2 cell) {
  const uint shift = pyramid_shift(level, pyramid.header.whole);
  const uint side = pyramid_nodes(pyramid.header.cells, shift);
  const uvec2 node = cell >> shift;
  return pyramid.nodes[pyramid.header.first[level] + (face * side + node.y) * side + node.x];
}

// At least the range of the cells lower … upper; exactly theirs in an MSSM.
vec2 depth_range_of_cells(uint face, uvec2 lower, uvec2 upper) {
  const PyramidQuery query = pyramid_query(lower, upper, pyramid.header.whole, pyramid.header.top);
  const uvec2 count = (query.to - query.from) / query.step + 1;
  // One loop: of two, one in the other and left at different turns by neighbours, Mesa 22.3 on processors loses some.
  vec2 range = vec2(1.0, 0.0);
  for (uint k = 0; k < count.x * count.y; ++k) {
    const uvec2 node = min(query.from + uvec2(k % count.x, k / count.x) * query.step, query.to + 1 - query.step);
    const vec2 part = pyramid_node(query.level, face, node << query.shift);
    range = vec2(min(range.x, part.x), max(range.y, part.y));
  }
  return range;
}

// At least the range of the texels lower … upper; exactly theirs in an MSSM if they are two or more a side.
vec2 depth_range(uint face, uvec2 lower, uvec2 upper) {
  return depth_range_of_cells(face, lower + 1, max(upper, lower + 1));
}
