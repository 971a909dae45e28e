// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: pyramids of smallest and largest depths over the maps of one light point, their queries and
// traversal. The same few lines of integers run in shaders and in the tests that count nodes.
//
// A map of size² texels has (size + 1)² *cells*: cell (i, j) lies between the texels (i − 1 … i, j − 1 … j), the dual
// grid of contours, and texels outside the map are empty. A node of level l at cell (x, y) covers the existing cells of
// x … x + 2^l − 1, y … y + 2^l − 1: the depths of (2^l + 1)² texels. Nodes of a level are 2^min(l, whole) cells apart,
// and `whole` distinguishes the three structures:
//   HSM   whole = top: a quadtree (Guennebaud 2006's hierarchical shadow map)
//   MSSM  whole = 0:   a node at every cell on every level (Schwarz and Stamminger 2007), on the dual grid (Yang 2009)
//   YSM   between:     a quadtree below, above it a node at each of the quadtree's (Schwarz and Stamminger 2008)
#include "maps/host/map_view.shared.h"
#ifndef PENUMBRA_MAPS_DEPTH_PYRAMID  // included more than once by shaders, hence an include guard in place of #pragma
                                     // once
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
const uint kPyramidLevels = 16;  // up to 2^15 cells: also for maps of 16384² texels
#endif

// Head of a pyramid's buffer; the nodes, pairs of floats, follow.
struct PyramidHeader {
  uint cells;                  // on a side: size + 1
  uint whole;                  // up to this level, nodes are spaced by their width
  uint top;                    // the coarsest level
  uint first[kPyramidLevels];  // first node of each level; level 0 of all faces, level 1 of all faces …
};

// Push constants of depth_pyramid.comp: one level.
struct PyramidPush {
  uint cells, faces, level;
  uint shift, shift_below;  // spacing of the nodes of this level and of the one below, as powers of two
  uint first, first_below;
};

// Returns the binary logarithm of the spacing of a level's nodes, in cells.
PENUMBRA_SHARED uint pyramid_shift(uint level, uint whole) {
  return level < whole ? level : whole;
}
// Returns the number of nodes on a side.
PENUMBRA_SHARED uint pyramid_nodes(uint cells, uint shift) {
  return ((cells - 1) >> shift) + 1;
}
// Returns the exponent of the largest power of two that is not above x > 0.
PENUMBRA_SHARED uint pyramid_log2(uint x) {
  uint exponent = 0;
  for (; x > 1; x >>= 1) ++exponent;
  return exponent;
}

// Nodes of a level that cover a rectangle of cells, counted in nodes of this level: columns from.x, from.x + step …,
// the last one at to.x + 1 − step; rows in the same form.
struct PyramidQuery {
  uint level, shift, step;
  uvec2 from, to;
};

// Returns the nodes of a query. On quadtree levels, these are up to 2 × 2 nodes of the finest level on which so many
// suffice. Above, they are the largest squares that fit into the rectangle, and they cover it exactly: four squares if
// the rectangle is about square, more if it is long.
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

// Depth-first traversal below one node, without a stack: a node's position below the root determines its index among
// its siblings.
struct PyramidWalk {
  uvec2 root, at;  // in cells
  uint top, level;
  bool done;
};

// Returns the finest level on which one node covers the rectangle: in an MSSM the node that begins at the rectangle's
// first cell, in an HSM the quadtree's node that contains this cell. If there is no such level, returns the coarsest:
// several roots then lie side by side.
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
// Moves to the first child.
PENUMBRA_SHARED PyramidWalk pyramid_down(PyramidWalk walk) {
  --walk.level;
  return walk;
}
// Moves past this node: to the next sibling, or the next one of the first ancestor that has one.
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
