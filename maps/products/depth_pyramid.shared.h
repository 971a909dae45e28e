// One struct, two languages: pyramids of smallest and largest depths over the maps of one light point, and how they are
// asked and walked. The same few lines of integers run in shaders and in the tests that count nodes.
//
// A map of size² texels has (size + 1)² *cells*: cell (i, j) lies between the texels (i − 1 … i, j − 1 … j), the dual
// grid on which contours run, and texels beyond the map are empty. A node of level l at cell (x, y) covers the cells x
// … x + 2^l − 1, y … y + 2^l − 1, as far as there are any: the depths of (2^l + 1)² texels. Nodes of a level stand
// 2^min(l, whole) cells apart, and `whole` is what tells the three structures from one another:
//   HSM   whole = top: a quadtree (Guennebaud 2006's hierarchical shadow map)
//   MSSM  whole = 0:   a node at every cell on every level (Schwarz and Stamminger 2007), on the dual grid (Yang 2009)
//   YSM   between:     a quadtree below, above it a node at each of the quadtree's (Schwarz and Stamminger 2008)
#include "maps/host/map_view.shared.h"
#ifndef PENUMBRA_MAPS_DEPTH_PYRAMID  // shaders include this in several ways
#define PENUMBRA_MAPS_DEPTH_PYRAMID
#ifdef __cplusplus
#pragma once
#include <glm/common.hpp>
namespace penumbra::maps::gpu {
using glm::uvec2;
#define PENUMBRA_SHARED constexpr
inline constexpr uint kPyramidLevels = 16;
#else
#define PENUMBRA_SHARED
const uint kPyramidLevels = 16;  // 2^15 cells and more: of maps of 16384² texels, too
#endif

// What stands at the start of a pyramid's buffer; the nodes, pairs of floats, follow.
struct PyramidHeader {
  uint cells;                  // a side: size + 1
  uint whole;                  // up to this level nodes stand as far apart as they are wide
  uint top;                    // the coarsest level
  uint first[kPyramidLevels];  // of each level, in nodes; level 0 of all faces, level 1 of all faces …
};

// depth_pyramid.comp: one level.
struct PyramidPush {
  uint cells, faces, level;
  uint shift, shift_below;  // how far apart the nodes of this level and of the one below stand, as powers of two
  uint first, first_below;
};

// Nodes of the level stand 2^this cells apart.
PENUMBRA_SHARED uint pyramid_shift(uint level, uint whole) {
  return level < whole ? level : whole;
}
// Nodes a side.
PENUMBRA_SHARED uint pyramid_nodes(uint cells, uint shift) {
  return ((cells - 1) >> shift) + 1;
}
// The exponent of the largest power of two that is not above x > 0.
PENUMBRA_SHARED uint pyramid_log2(uint x) {
  uint exponent = 0;
  for (; x > 1; x >>= 1) ++exponent;
  return exponent;
}

// The nodes that cover a rectangle of cells: columns from.x, from.x + step … of a level, the last one at to.x + 1 −
// step; likewise rows; in nodes of that level.
struct PyramidQuery {
  uint level, shift, step;
  uvec2 from, to;
};

// Of the quadtree levels the finest of which 2 × 2 nodes suffice; above, the largest squares that fit into the
// rectangle, which cover it and nothing else: four if it is about square, more if it is long.
PENUMBRA_SHARED PyramidQuery pyramid_query(uvec2 lower, uvec2 upper, uint whole, uint top) {
  PyramidQuery query;
  uint pair = 0;
  while ((upper.x >> pair) - (lower.x >> pair) > 1 || (upper.y >> pair) - (lower.y >> pair) > 1) ++pair;
  query.shift = pyramid_shift(pair, whole);
  query.from = uvec2(lower.x >> query.shift, lower.y >> query.shift);
  query.to = uvec2(upper.x >> query.shift, upper.y >> query.shift);
  query.level = pair;
  if (pair > whole) {
    const uvec2 extent = query.to - query.from + uvec2(1);
    const uint level = whole + pyramid_log2(extent.x < extent.y ? extent.x : extent.y);
    query.level = level < top ? level : top;
  }
  query.step = 1u << (query.level - query.shift);
  return query;
}

// A depth-first walk below one node, without a stack: a node's place below the root says which child it is.
struct PyramidWalk {
  uvec2 root, at;  // in cells
  uint top, level;
  bool done;
};

// The finest level with a node that begins with the rectangle (as nodes stand: at its first cell in an MSSM, at the
// quadtree's node that holds it in an HSM) and covers it; if no level has, the coarsest: roots then stand side by side.
PENUMBRA_SHARED uint pyramid_root_level(uvec2 lower, uvec2 upper, uint whole, uint top) {
  for (uint level = 0; level < top; ++level) {
    const uint shift = pyramid_shift(level, whole), width = 1u << level;
    if (((lower.x >> shift) << shift) + width > upper.x && ((lower.y >> shift) << shift) + width > upper.y)
      return level;
  }
  return top;
}
PENUMBRA_SHARED PyramidWalk pyramid_walk(uvec2 root, uint level) {
  PyramidWalk walk;
  walk.root = root;
  walk.at = root;
  walk.top = level;
  walk.level = level;
  walk.done = false;
  return walk;
}
// To the first child.
PENUMBRA_SHARED PyramidWalk pyramid_down(PyramidWalk walk) {
  --walk.level;
  return walk;
}
// Past this node: to the next sibling, or the next one of the first ancestor that has one.
PENUMBRA_SHARED PyramidWalk pyramid_past(PyramidWalk walk) {
  for (; walk.level < walk.top; ++walk.level) {
    const uint width = 1u << walk.level;
    if (((walk.at.x - walk.root.x) & width) == 0) {
      walk.at.x += width;
      return walk;
    }
    walk.at.x -= width;
    if (((walk.at.y - walk.root.y) & width) == 0) {
      walk.at.y += width;
      return walk;
    }
    walk.at.y -= width;
  }
  walk.done = true;
  return walk;
}

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#undef PENUMBRA_SHARED
#endif  // PENUMBRA_MAPS_DEPTH_PYRAMID
