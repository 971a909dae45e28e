#include "engines/vectors/trees.hpp"

#include "base/pages.hpp"
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

std::vector<WideNode> wide_nodes(std::span<const Texel> texels, std::size_t stride) {
  std::vector<WideNode> nodes;
  resize_on_all_cores(nodes, texels.size() / stride / kWide);
  mesh::for_each_index(nodes.size(), [&](std::size_t n) {
    WideNode& node = nodes[n];
    for (std::size_t lane = 0; lane < kWide; ++lane) {
      const auto at = texels.subspan((n * kWide + lane) * stride, stride);
      store(node.middle, lane, at[0].value);
      store(node.half, lane, at[1].value);
      node.reference[lane] = at[0].number;
      if (at[0].number != TriangleTree::kNoChild) node.used |= 1U << lane;
      if (stride < 3) continue;
      for (int i = 0; i < 3; ++i) node.cone[static_cast<std::size_t>(i)][lane] = at[2].value[i];
      node.cone[3][lane] = std::bit_cast<float>(at[2].number);
    }
  });
  return nodes;
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
  tree.leaves.insert(tree.leaves.end(), more.leaves.begin(), more.leaves.end());
}

WideTriangleTree wide_triangle_tree(const visibility::SceneFloats& scene, const TriangleTree& tree, float scale) {
  WideTriangleTree wide;
  const std::vector<Texel> texels = visibility::node_texels(tree, scale);
  wide.nodes = wide_nodes(texels, 2);
  if (!wide.nodes.empty()) wide.roots = {0};
  resize_on_all_cores(wide.leaves, tree.leaves.size());
  mesh::for_each_index(tree.leaves.size(), [&](std::size_t i) {
    WideTriangles& leaf = wide.leaves[i];
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
