// SPDX-License-Identifier: Apache-2.0
// Refitting of a hierarchy's boxes for the next frame, and its cost by the surface area heuristic.

#include "visibility/tree/tree_refit.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>
#include <vector>

namespace penumbra::visibility {
namespace {

double half_area(const glm::vec3& lower, const glm::vec3& upper) {
  const glm::dvec3 size = glm::dvec3(upper) - glm::dvec3(lower);
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

Bounds nowhere() {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  return {glm::vec3(kFar), glm::vec3(-kFar)};
}

void add_to(Bounds& all, const Bounds& one) {
  all.lower = glm::min(all.lower, one.lower);
  all.upper = glm::max(all.upper, one.upper);
}

bool is_nowhere(const Bounds& box) {
  return box.lower.x > box.upper.x;
}

}  // namespace

double tree_cost(const TriangleTree& tree) {
  double sum = 0;
  Bounds root = nowhere();
  for (std::size_t node = 0; node < tree.nodes.size(); ++node) {
    for (const TriangleTree::Child& child : tree.nodes[node]) {
      if (child.reference == TriangleTree::kNoChild) continue;
      sum += half_area(child.lower, child.upper);
      if (node == 0) add_to(root, {child.lower, child.upper});
    }
  }
  const double whole = is_nowhere(root) ? 0 : half_area(root.lower, root.upper);
  return whole > 0 ? sum / whole : 0;
}

void refit_tree(TriangleTree& tree, const std::function<Bounds(std::uint32_t)>& box,
                const std::function<bool(std::size_t leaf)>& has_moved) {
  std::vector<std::optional<Bounds>> of_leaf(tree.leaves.size());
  for_each_index(tree.leaves.size(), [&](std::size_t leaf) {
    if (!has_moved(leaf)) return;
    Bounds& its = of_leaf[leaf].emplace(nowhere());
    for (const std::uint32_t number : tree.leaves[leaf]) {
      if (number != TriangleTree::kNoTriangle) add_to(its, box(number));
    }
  });
  // Nodes have lower indices than those below them. There are few: one for about fifty triangles.
  std::vector<Bounds> of_node(tree.nodes.size());
  for (std::size_t node = tree.nodes.size(); node-- > 0;) {
    Bounds all = nowhere();
    for (TriangleTree::Child& child : tree.nodes[node]) {
      if (child.reference == TriangleTree::kNoChild) continue;
      const std::uint32_t number = child.reference & ~TriangleTree::kLeafBit;
      const bool leaf = number != child.reference;
      PENUMBRA_ASSERT(leaf || number > node, "node {} below {}", number, node);
      const Bounds its = leaf ? of_leaf[number].value_or(Bounds{child.lower, child.upper}) : of_node[number];
      child.lower = its.lower;
      child.upper = its.upper;
      add_to(all, its);
    }
    of_node[node] = all;
  }
  if (tree.nodes.empty() || is_nowhere(of_node[0])) return;
  for (TriangleTree::Node& node : tree.nodes) {
    for (TriangleTree::Child& child : node) {
      if (child.reference != TriangleTree::kNoChild && is_nowhere({child.lower, child.upper}))
        child.lower = child.upper = of_node[0].lower;
    }
  }
}

bool holds_casters(const TriangleTree& tree, const SceneFloats& scene) {
  std::atomic<std::size_t> held = 0, wrong = 0;
  for_each_index(tree.leaves.size(), [&](std::size_t leaf) {
    std::size_t here = 0;
    for (const std::uint32_t triangle : tree.leaves[leaf]) {
      if (triangle == TriangleTree::kNoTriangle) continue;
      ++here;
      if (triangle >= scene.casts_shadow.size() || scene.casts_shadow[triangle] == 0) ++wrong;
    }
    held += here;
  });
  return wrong == 0 && held == static_cast<std::size_t>(std::ranges::count_if(
                                   scene.casts_shadow, [](std::uint8_t casts) { return casts != 0; }));
}

void refit_triangle_tree(TriangleTree& tree, const SceneFloats& scene) {
  const auto box = [&](std::uint32_t triangle) {
    const auto [a, b, c] = scene.corners(triangle);
    return Bounds{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
  };
  refit_tree(tree, box, [](std::size_t) { return true; });
}

}  // namespace penumbra::visibility
