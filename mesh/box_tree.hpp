// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::mesh {

/// An axis-aligned, closed box. Empty (lower > upper) by default.
struct Box {
  glm::dvec3 lower{1.7976931348623157e308}, upper{-1.7976931348623157e308};

  void include(const glm::dvec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
  void include(const Box& box) { lower = glm::min(lower, box.lower), upper = glm::max(upper, box.upper); }
  [[nodiscard]] bool meets(const Box& other) const {
    return lower.x <= other.upper.x && lower.y <= other.upper.y && lower.z <= other.upper.z &&
           other.lower.x <= upper.x && other.lower.y <= upper.y && other.lower.z <= upper.z;
  }
};

/// A binary tree over boxes, split at medians: balanced for every distribution, and a function of the boxes alone.
/// Level d has 2^d nodes; node j of it holds the items at [n j / 2^d, n (j + 1) / 2^d) of `order`.
class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes);

  /// Returns the items' indices, close items together.
  [[nodiscard]] std::span<const std::uint32_t> order() const& { return order_; }
  std::span<const std::uint32_t> order() const&& = delete;

  /// Calls visit(item) for every item whose box satisfies `reaches(box)`; reaches must be true for every box that
  /// contains one for which it is true.
  template <typename Reaches, typename Visit>
  void find(const Reaches& reaches, const Visit& visit) const {
    find([](std::uint32_t) { return true; }, reaches, visit);
  }
  /// Calls visit as above, but skips everything below nodes for which `enters(node)` is false.
  template <typename Enters, typename Reaches, typename Visit>
  void find(const Enters& enters, const Reaches& reaches, const Visit& visit) const {
    if (order_.empty()) return;
    std::array<std::uint32_t, 64> stack;  // heap indices, from 1; at most one waiting node per level
    std::size_t waiting = 0;
    stack[waiting++] = 1;
    while (waiting > 0) {
      const std::uint32_t node = stack[--waiting];
      if (!reaches(nodes_[node]) || !enters(node)) continue;
      if (node < leaves_) {
        stack[waiting++] = 2 * node + 1;
        stack[waiting++] = 2 * node;
        continue;
      }
      for (std::size_t i = begin_of_leaf(node); i < begin_of_leaf(node + 1); ++i) {
        if (reaches(boxes_[i])) visit(order_[i]);
      }
    }
  }

  /// Returns for each node, by heap index, the values value_of(item) of all items below the node, combined by
  /// join(value, value).
  template <typename ValueOf, typename Join>
  [[nodiscard]] auto fold(const ValueOf& value_of, const Join& join) const {
    std::vector<decltype(value_of(std::uint32_t{}))> values(nodes_.size());
    if (order_.empty()) return values;
    for (std::uint32_t node = 2 * leaves_; node-- > leaves_;) {
      values[node] = value_of(order_[begin_of_leaf(node)]);
      for (std::size_t i = begin_of_leaf(node) + 1; i < begin_of_leaf(node + 1); ++i) {
        values[node] = join(values[node], value_of(order_[i]));
      }
    }
    for (std::uint32_t node = leaves_; node-- > 1;) values[node] = join(values[2 * node], values[2 * node + 1]);
    return values;
  }

 private:
  [[nodiscard]] std::size_t begin_of_leaf(std::uint32_t node) const {
    return order_.size() * (node - leaves_) / leaves_;
  }
  struct Builder;

  std::uint32_t leaves_ = 1;  ///< a power of two
  std::vector<std::uint32_t> order_;
  std::vector<Box> nodes_, boxes_;  ///< nodes_ in heap order; boxes_ of the items, in the order of `order_`
};

}  // namespace penumbra::mesh
