// SPDX-License-Identifier: Apache-2.0
// Converts hierarchies of triangles and edges to nodes and leaves with eight entries for vector code.

#include "engines/vectors/trees.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"

#include <bit>

namespace penumbra::vectors {
namespace {

using visibility::Texel;
using visibility::TriangleTree;

void store(WidePoints& points, std::size_t lane, const glm::vec3& x) {
  for (int axis = 0; axis < 3; ++axis) points[static_cast<std::size_t>(axis)][lane] = x[axis];
}

}  // namespace

void store(WideNode& node, std::size_t lane, std::span<const Texel> texels) {
  store(node.middle, lane, texels[0].value);
  store(node.half, lane, texels[1].value);
  node.reference[lane] = texels[0].number;
  if (texels[0].number != TriangleTree::kNoChild) node.used |= 1U << lane;
  if (texels.size() < 3) return;
  for (int i = 0; i < 3; ++i) node.cone[static_cast<std::size_t>(i)][lane] = texels[2].value[i];
  node.cone[3][lane] = std::bit_cast<float>(texels[2].number);
}

void append(WideEdgeTree& tree, const WideEdgeTree& more) {
  const auto first_node = static_cast<std::uint32_t>(tree.nodes.size());
  const auto first_leaf = static_cast<std::uint32_t>(tree.leaves.size());
  for (const std::uint32_t root : more.roots) tree.roots.push_back(first_node + root);
  for (WideNode node : more.nodes) {
    for (std::uint32_t& reference : node.reference) {
      if (reference != TriangleTree::kNoChild)
        reference += (reference & TriangleTree::kLeafBit) != 0 ? first_leaf : first_node;
    }
    tree.nodes.push_back(node);
  }
  tree.leaves.append(more.leaves);
}

WideTriangleTree wide_triangle_tree(const visibility::SceneFloats& scene, const TriangleTree& tree, float scale,
                                    WideTriangleTree wide) {
  if (wide.nodes.empty()) wide.nodes.resize(tree.nodes.size());
  PENUMBRA_ASSERT(wide.nodes.size() == tree.nodes.size(), "{} nodes of {}", wide.nodes.size(), tree.nodes.size());
  for_each_index(wide.nodes.size(), [&](std::size_t node) {
    WideNode& at = wide.nodes[node] = {};
    for (std::size_t lane = 0; lane < kWide; ++lane)
      store(at, lane, visibility::child_texels(tree.nodes[node][lane], scale));
  });
  if (!wide.nodes.empty()) wide.roots = {0};
  wide.leaves.make(tree.leaves.size(), [&scene, &tree, scale](std::size_t i, WideTriangles& leaf) {
    for (std::size_t lane = 0; lane < kWide; ++lane) {
      const std::uint32_t triangle = tree.leaves[i][lane];
      if (triangle == TriangleTree::kNoTriangle) continue;
      const auto corners = scene.corners(triangle);
      for (std::size_t corner = 0; corner < 3; ++corner) store(leaf.corner[corner], lane, corners[corner] * scale);
      leaf.plane[lane] = scene.plane[triangle];
      leaf.emits[lane] = static_cast<std::uint32_t>(scene.emits[triangle]);
      leaf.used |= 1U << lane;
    }
  });
  return wide;
}

}  // namespace penumbra::vectors
