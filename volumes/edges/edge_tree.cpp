// SPDX-License-Identifier: Apache-2.0
// Builds hierarchies over edge records with cones of normals, and converts them to texels for devices.

#include "volumes/edges/edge_tree.hpp"

#include "base/parallel.hpp"
#include "visibility/tree/tree_along.hpp"

#include <glm/common.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace penumbra::volumes {
namespace {

using Cone = NormalCone;
using visibility::TriangleTree;

class Cones {
 public:
  Cones(const TriangleTree& tree, const std::function<LeafNormals(std::size_t)>& normals_of, LeafCones* kept)
      : tree_(tree) {
    of_child_.resize(tree.nodes.size() * TriangleTree::kWidth);
    if (kept != nullptr) of_leaf_ = std::move(kept->cones);
    const bool known = !of_leaf_.empty();
    of_leaf_.resize(tree.leaves.size());
    for_each_index(of_leaf_.size(), [&](std::size_t i) {
      if (!known || kept->has_moved(i)) of_leaf_[i] = cone_of(normals_of(i));
    });
    if (!tree.nodes.empty()) static_cast<void>(of_node(0, 0));
  }
  [[nodiscard]] const Cone& of_child(std::size_t node, std::size_t child) const {
    return of_child_[node * TriangleTree::kWidth + child];
  }
  [[nodiscard]] UnsetList<Cone> of_leaves() && { return std::move(of_leaf_); }

 private:
  static constexpr std::uint32_t kTaskLevels = 3;  // 512 tasks

  Cone of_node(std::uint32_t node, std::uint32_t level) {
    const std::span<Cone> own =
        std::span(of_child_).subspan(std::size_t{node} * TriangleTree::kWidth, TriangleTree::kWidth);
    const auto of_child = [&](std::size_t i) {
      const std::uint32_t reference = tree_.nodes[node][i].reference;
      own[i] = {};
      if (reference == TriangleTree::kNoChild) return;
      const bool leaf = (reference & TriangleTree::kLeafBit) != 0;
      own[i] = leaf ? of_leaf_[reference & ~TriangleTree::kLeafBit] : of_node(reference, level + 1);
    };
    if (level < kTaskLevels) {
      tbb::parallel_for(std::size_t{0}, std::size_t{TriangleTree::kWidth}, of_child);
    } else {
      for (std::size_t i = 0; i < TriangleTree::kWidth; ++i) of_child(i);
    }
    const auto count = std::ranges::count_if(
        tree_.nodes[node], [](const auto& child) { return child.reference != TriangleTree::kNoChild; });
    return joined(own.first(static_cast<std::size_t>(count)));
  }

  const TriangleTree& tree_;
  UnsetList<Cone> of_child_, of_leaf_;
};

template <typename Records>
EdgeTexels texels_of(const TriangleTree& tree, const Records& records, float scale) {
  EdgeTexels texels;
  texels.depth = tree.depth;
  texels.records = static_cast<std::uint32_t>(records.size());
  for (auto& list : texels.slots) list.resize(tree.leaves.size() * TriangleTree::kWidth);
  for_each_index(tree.leaves.size() * TriangleTree::kWidth, [&](std::size_t i) {
    const std::uint32_t number = tree.leaves[i / TriangleTree::kWidth][i % TriangleTree::kWidth];
    const bool used = number != TriangleTree::kNoTriangle;
    const EdgeRecord record = used ? records[number] : EdgeRecord{};
    const auto& [s, t] = record.sides;
    texels.slots[0][i] = {record.a * scale, s.plane};
    texels.slots[1][i] = {record.b * scale, t.plane};
    texels.slots[2][i] = {s.n, used ? 1U : 0U};
    texels.slots[3][i] = {s.anchor * scale, used ? 1U : 0U};
    texels.slots[4][i] = {t.n, used ? 1U : 0U};
    texels.slots[5][i] = {t.anchor * scale, used ? 1 + record.cut : 0U};
  });
  const auto normals_of = [&](std::size_t leaf) {
    LeafNormals normals;
    const auto n = [&](std::size_t list) { return texels.slots[list][leaf * TriangleTree::kWidth + normals.count]; };
    for (; normals.count < TriangleTree::kWidth && n(2).number != 0; ++normals.count)
      normals.n[normals.count] = {n(2).value, n(4).value};
    return normals;
  };
  constexpr std::size_t kTexels = std::size_t{3} * TriangleTree::kWidth;  // texels of a node
  texels.nodes.resize(tree.nodes.size() * kTexels);
  for_each_edge_node(tree, scale, normals_of, [&](std::size_t node, std::span<const EdgeChild> children) {
    for (std::size_t i = 0; i < kTexels; ++i) texels.nodes[node * kTexels + i] = children[i / 3][i % 3];
  });
  if (texels.nodes.empty()) texels.nodes.emplace_back();  // a buffer must not be empty
  for (auto& list : texels.slots) {
    if (list.empty()) list.emplace_back();
  }
  return texels;
}

}  // namespace

TriangleTree edge_tree(const EdgeRecords& records, const TriangleTree& triangles) {
  return visibility::make_tree_along(triangles, {.count = records.size(),
                                                 .box = [&](std::size_t i) { return records.box(i); },
                                                 .triangle = [&](std::size_t i) { return records.triangle(i); }});
}

TriangleTree edge_tree(std::span<const EdgeRecord> records) {
  std::vector<visibility::Bounds> boxes(records.size());
  for_each_index(boxes.size(), [&](std::size_t i) {
    boxes[i] = {glm::min(records[i].a, records[i].b), glm::max(records[i].a, records[i].b)};
  });
  return visibility::make_tree_over(boxes);
}

void for_each_edge_node(const TriangleTree& tree, float scale,
                        const std::function<LeafNormals(std::size_t)>& normals_of,
                        const std::function<void(std::size_t, std::span<const EdgeChild>)>& take, LeafCones* kept) {
  Cones cones(tree, normals_of, kept);
  for_each_index(tree.nodes.size(), [&](std::size_t node) {
    std::array<EdgeChild, TriangleTree::kWidth> children;
    for (std::size_t child = 0; child < children.size(); ++child) {
      const auto [middle, half] = visibility::child_texels(tree.nodes[node][child], scale);
      const Cone& cone = cones.of_child(node, child);
      // Slightly widened: float32 rounds axis and cosine by 2⁻²⁴ each. An angle near 0 is off by the root of its
      // cosine's rounding, 2⁻²⁶, a few times for each level, which is less than a quarter of the margin in 20 levels.
      const auto cosine = static_cast<float>(std::max(cone.cosine - 0x1p-18, 0.0));
      children[child] = {
          middle, half, {glm::vec3(cone.axis), std::bit_cast<std::uint32_t>(cone.is_all() ? 0.0F : cosine)}};
    }
    take(node, children);
  });
  if (kept != nullptr) kept->cones = std::move(cones).of_leaves();
}

EdgeTexels edge_texels(const EdgeRecords& records, const TriangleTree& triangles, float scale) {
  return texels_of(edge_tree(records, triangles), records, scale);
}

EdgeTexels edge_texels(std::span<const EdgeRecord> records, float scale) {
  return texels_of(edge_tree(records), records, scale);
}

}  // namespace penumbra::volumes
