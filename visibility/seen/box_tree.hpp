// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// An axis-aligned box, by its middle and half its sides; in double, since each mesh has its own space.
struct MiddleBox {
  glm::dvec3 middle{0}, half{0};
};

/// A hierarchy over boxes, two children per node: each node is divided between two of sixteen slices, by the surface
/// area heuristic; far down, or where all middles are the same, in halves.
class BoxTree {
 public:
  struct Node {
    MiddleBox box;
    std::uint32_t first = 0;  ///< leaf: index into items(); inner node: second child (the first one follows the node)
    std::uint32_t count = 0;  ///< number of items of a leaf; 0: inner node
  };
  /// Largest number of nodes on the path from the root to a leaf.
  static constexpr std::uint32_t kDepth = 64;

  BoxTree() = default;
  /// Builds a tree whose leaves have up to `most` boxes.
  BoxTree(std::span<const MiddleBox> boxes, std::uint32_t most);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] const Node& root() const { return nodes_.front(); }
  [[nodiscard]] const Node& node(std::uint32_t number) const { return nodes_[number]; }
  [[nodiscard]] std::span<const std::uint32_t> items(const Node& leaf) const {
    return std::span(items_).subspan(leaf.first, leaf.count);
  }
  [[nodiscard]] std::uint64_t bytes() const {
    return nodes_.capacity() * sizeof(Node) + items_.capacity() * sizeof(std::uint32_t);
  }

  /// Calls take(items) for each leaf for which touches(box) holds, for the leaf and for all nodes above it.
  template <typename Touches, typename Take>
  void walk(const Touches& touches, const Take& take) const;

 private:
  struct Range {
    std::uint32_t first = 0, count = 0, depth = 0;
  };
  std::uint32_t build(std::span<const MiddleBox> boxes, const Range& range, std::uint32_t most);
  std::uint32_t divide(std::span<const MiddleBox> boxes, const Range& range, const glm::dvec3& least,
                       const glm::dvec3& greatest);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

template <typename Touches, typename Take>
void BoxTree::walk(const Touches& touches, const Take& take) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, kDepth> stack;
  std::uint32_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t number = stack[--top];
    const Node& node = nodes_[number];
    if (!touches(node.box)) continue;
    if (node.count > 0) {
      take(items(node));
      continue;
    }
    stack[top++] = node.first;
    stack[top++] = number + 1;
  }
}

}  // namespace penumbra::visibility
