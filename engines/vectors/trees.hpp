// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/pages.hpp"
#include "engines/vectors/wide_leaves.hpp"
#include "visibility/tree/tree_texels.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Hierarchies for a processor's vector units: eight children, edges or triangles side by side, all numbers scaled like
/// the device's.
namespace penumbra::vectors {

constexpr std::size_t kWide = 8;
using WideFloats = std::array<float, kWide>;
using WideWords = std::array<std::uint32_t, kWide>;
using WidePoints = std::array<WideFloats, 3>;  ///< x, y, z

struct alignas(64) WideNode {
  WidePoints middle, half;
  std::array<WideFloats, 4> cone;  ///< cone of normals: axis, cosine
  WideWords reference;             ///< TriangleTree::Child::reference
  std::uint32_t used = 0;          ///< a bit for each child
};

/// Edges, each with the planes of two of its triangles. Unused ones have used = 0.
struct alignas(64) WideEdges {
  WidePoints a, b;
  std::array<WidePoints, 2> n, anchor;
  std::array<WideWords, 2> plane;
  WideWords cut;  ///< 0, or the index, from 1, of a method's data about an edge's ends in addition to a and b
  std::uint32_t used = 0;
};

struct alignas(64) WideTriangles {
  std::array<WidePoints, 3> corner;
  WideWords plane, emits;  ///< emits: the light whose body the triangle is
  WideWords closed{};      ///< a bit for the triangle's closed part, its corners then wound so that normals point
                           ///< inward; or 0 (vsm/closed_parts.hpp)
  std::uint32_t used = 0;
};

struct WideEdgeTree {
  std::vector<std::uint32_t> roots;  ///< empty, or node 0 and the roots of appended trees
  UnsetList<WideNode> nodes;
  WideLeaves<WideEdges> leaves;
};
struct WideTriangleTree {
  std::vector<std::uint32_t> roots;  ///< empty, or node 0
  UnsetList<WideNode> nodes;
  WideLeaves<WideTriangles> leaves;
};

/// Appends a tree as one more root.
void append(WideEdgeTree& tree, const WideEdgeTree& more);
/// Makes a wide tree. Large trees make leaves on demand: `scene` and `tree` must then stay unchanged. `memory`: a tree
/// of the same form whose nodes, and leaves if they are few, are overwritten.
WideTriangleTree wide_triangle_tree(const visibility::SceneFloats& scene, const visibility::TriangleTree& tree,
                                    float scale, WideTriangleTree memory = {});

/// Stores a child's texels: (middle, reference), (half extent, –) and, if there are three, (axis, cosine) of its cone,
/// in the format of volumes/edges/edge_set.hpp.
void store(WideNode& node, std::size_t lane, std::span<const visibility::Texel> texels);

template <typename Tree>
std::uint64_t bytes_of(const Tree& tree) {
  const std::uint64_t nodes = tree.nodes.size() * sizeof(tree.nodes[0]);
  if constexpr (requires { tree.leaves.memory_bytes(); })
    return nodes + tree.leaves.memory_bytes();
  else
    return nodes + tree.leaves.size() * sizeof(tree.leaves[0]);
}

}  // namespace penumbra::vectors
