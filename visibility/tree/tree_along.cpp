// SPDX-License-Identifier: Apache-2.0
// Builds a tree over many boxes with the divisions of an existing tree of triangles.

#include "visibility/tree/tree_along.hpp"

#include "base/assert.hpp"
#include "base/buckets.hpp"
#include "base/parallel.hpp"
#include "visibility/tree/halves.hpp"

#include <glm/common.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace penumbra::visibility {
namespace {

using Child = TriangleTree::Child;

constexpr std::size_t kWidth = TriangleTree::kWidth;
constexpr std::size_t kTogether = kWidth * kWidth;    // for at most this many boxes the guide is not used
constexpr std::size_t kTask = std::size_t{1} << 13U;  // boxes that justify a separate task

bool is_leaf(std::uint32_t reference) {
  return (reference & TriangleTree::kLeafBit) != 0;
}

void include(Bounds& all, const Bounds& one) {
  all.lower = glm::min(all.lower, one.lower);
  all.upper = glm::max(all.upper, one.upper);
}

Bounds nothing() {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  return {glm::vec3(kFar), glm::vec3(-kFar)};
}

/// Numbers of nodes and leaves of a subtree, including its root, and of nodes on its longest path.
struct Size {
  std::uint32_t nodes = 0, leaves = 0, depth = 0;

  void add(const Size& child, std::uint32_t times = 1) {
    nodes += times * child.nodes;
    leaves += times * child.leaves;
    depth = std::max(depth, child.depth);
  }
  /// Adds a node above the added subtrees.
  void close() {
    ++nodes;
    ++depth;
  }
};

/// Returns the number of boxes in each part below a node: 8, 64, … so that all leaves but the last are full.
std::size_t step_of(std::size_t count) {
  std::size_t step = kWidth;
  while (step * kWidth < count) step *= kWidth;
  return step;
}

Size size_of(std::size_t count) {
  if (count <= kWidth) return {0, count > 0 ? 1U : 0U, 0};
  const std::size_t step = step_of(count);
  Size size;
  size.add(size_of(step), static_cast<std::uint32_t>(count / step));
  size.add(size_of(count % step));
  size.close();
  return size;
}

/// The beginning of a subtree: its root is the first of its nodes, or, if it has none, its leaf.
struct Place {
  std::uint32_t node = 0, leaf = 0;

  [[nodiscard]] std::uint32_t reference(const Size& size) const {
    return size.nodes > 0 ? node : leaf | TriangleTree::kLeafBit;
  }
  void pass(const Size& size) {
    node += size.nodes;
    leaf += size.leaves;
  }
};

/// Divides boxes in halves, into places of a tree. One for each thread.
class Divider {
 public:
  Bounds divide(const BoxesNear& all, std::span<const std::uint32_t> numbers, const Place& place, TriangleTree& tree) {
    tree_ = &tree;
    numbers_ = numbers;
    boxes_.clear();
    items_.clear();
    for (const std::uint32_t number : numbers) {
      const Bounds& box = boxes_.emplace_back(all.box(number));
      items_.push_back({box.lower + box.upper, static_cast<std::uint32_t>(items_.size())});
    }
    return divide(std::span(items_), place);
  }

 private:
  Bounds divide(std::span<Divided> items, const Place& place) {
    if (items.size() <= kWidth) return leaf(items, place.leaf);
    Bounds all = nothing();
    Place next{place.node + 1, place.leaf};
    TriangleTree::Node& node = tree_->nodes[place.node] = {};
    std::size_t count = 0;
    halve(items, step_of(items.size()), [&](std::span<Divided> part) {
      const Size size = size_of(part.size());
      const Bounds box = divide(part, next);
      node[count++] = {box.lower, box.upper, next.reference(size)};
      include(all, box);
      next.pass(size);
    });
    return all;
  }

  Bounds leaf(std::span<const Divided> items, std::uint32_t number) {
    TriangleTree::Leaf& slots = tree_->leaves[number];
    slots.fill(TriangleTree::kNoTriangle);
    Bounds all = nothing();
    for (std::size_t i = 0; i < items.size(); ++i) {
      slots[i] = numbers_[items[i].at];
      include(all, boxes_[items[i].at]);
    }
    std::sort(slots.begin(), slots.end());  // kNoTriangle is the largest
    return all;
  }

  TriangleTree* tree_ = nullptr;
  std::span<const std::uint32_t> numbers_;  // indices of the boxes to divide
  std::vector<Bounds> boxes_;
  std::vector<Divided> items_;
};

class Along {
 public:
  Along(const TriangleTree& guide, const BoxesNear& boxes)
      : guide_(guide), boxes_(boxes), end_(guide.nodes.size()), size_(guide.nodes.size()) {
    static_cast<void>(find_end(0, 0));
    std::uint32_t most = 0;
    for (const TriangleTree::Leaf& leaf : guide.leaves) {
      for (const std::uint32_t triangle : leaf)
        most = triangle < TriangleTree::kNoTriangle ? std::max(most, triangle) : most;
    }
    std::vector<std::uint32_t> leaf_of(std::size_t{most} + 1, TriangleTree::kNoTriangle);
    for_each_index(guide.leaves.size(), [&](std::size_t leaf) {
      for (const std::uint32_t triangle : guide.leaves[leaf]) {
        if (triangle <= most) leaf_of[triangle] = static_cast<std::uint32_t>(leaf);
      }
    });
    by_leaf_ = into_buckets(boxes.count, guide.leaves.size(), [&](std::size_t i) {
      const std::uint32_t near = boxes.triangle(i);
      PENUMBRA_ASSERT(near <= most && leaf_of[near] != TriangleTree::kNoTriangle, "box {}: no leaf has triangle {}", i,
                      near);
      return leaf_of[near];
    });
  }

  TriangleTree make() {
    const Part whole{0, 0};
    find_size(whole);
    Size all = size_of_part(whole);
    const bool alone = all.nodes == 0;  // a single leaf gets a node above it
    if (alone) all.close();
    tree_.leaves.resize(all.leaves);
    tree_.nodes.resize(all.nodes);
    tree_.depth = all.depth;
    const Bounds box = place(whole, {});
    if (alone) tree_.nodes[0] = {Child{box.lower, box.upper, TriangleTree::kLeafBit}};
    return std::move(tree_);
  }

 private:
  /// A subtree of the guide: a node or leaf, and its first leaf.
  struct Part {
    std::uint32_t reference, first;
  };

  /// The leaves below a node are contiguous; returns the end of those below this one.
  std::uint32_t find_end(std::uint32_t node, std::uint32_t first) {
    for (const Child& child : guide_.nodes[node]) {
      if (child.reference == TriangleTree::kNoChild) continue;
      const std::uint32_t number = child.reference & ~TriangleTree::kLeafBit;
      PENUMBRA_ASSERT(!is_leaf(child.reference) || number == first, "leaf {} where {} comes next", number, first);
      first = is_leaf(child.reference) ? first + 1 : find_end(number, first);
    }
    return end_[node] = first;
  }
  [[nodiscard]] std::uint32_t end_of(const Part& part) const {
    return is_leaf(part.reference) ? part.first + 1 : end_[part.reference];
  }
  [[nodiscard]] std::span<const std::uint32_t> boxes_of(const Part& part) const {
    const std::uint32_t begin = by_leaf_.first[part.first], end = by_leaf_.first[end_of(part)];
    return std::span(by_leaf_.items).subspan(begin, end - begin);
  }
  template <typename Visit>
  void for_each_child(const Part& part, const Visit& visit) const {
    std::uint32_t first = part.first;
    for (const Child& child : guide_.nodes[part.reference]) {
      if (child.reference == TriangleTree::kNoChild) continue;
      const Part one{child.reference, first};
      visit(one);
      first = end_of(one);
    }
  }

  /// Returns whether the reference is a leaf, or has only leaves below it.
  [[nodiscard]] bool is_last(std::uint32_t reference) const {
    return is_leaf(reference) || std::ranges::all_of(guide_.nodes[reference], [](const Child& child) {
             return child.reference == TriangleTree::kNoChild || is_leaf(child.reference);
           });
  }

  /// Returns whether the guide divides the part.
  [[nodiscard]] bool is_divided(const Part& part) const {
    return boxes_of(part).size() > kTogether && !is_last(part.reference);
  }

  /// Computes sizes for the guide's nodes that divide.
  void find_size(const Part& part) {
    if (!is_divided(part)) return;
    Size size;
    for_each_child(part, [&](const Part& child) {
      find_size(child);
      size.add(size_of_part(child));
    });
    size.close();
    size_[part.reference] = size;
  }
  [[nodiscard]] Size size_of_part(const Part& part) const {
    return is_divided(part) ? size_[part.reference] : size_of(boxes_of(part).size());
  }

  Bounds place(const Part& part, const Place& at) {
    if (!is_divided(part)) return dividers_.local().divide(boxes_, boxes_of(part), at, tree_);
    std::array<Bounds, kWidth> boxes;
    tbb::task_group tasks;
    Place next{at.node + 1, at.leaf};
    std::size_t count = 0;
    TriangleTree::Node& node = tree_.nodes[at.node] = {};
    for_each_child(part, [&](const Part& child) {
      const Size size = size_of_part(child);
      if (size.leaves == 0) return;  // no box is near the part
      node[count].reference = next.reference(size);
      const auto below = [this, child, next, &box = boxes[count]] { box = place(child, next); };
      if (boxes_of(child).size() > kTask)
        tasks.run(below);
      else
        below();
      next.pass(size);
      ++count;
    });
    tasks.wait();
    Bounds all = nothing();
    for (std::size_t i = 0; i < count; ++i) {
      node[i].lower = boxes[i].lower;
      node[i].upper = boxes[i].upper;
      include(all, boxes[i]);
    }
    return all;
  }

  const TriangleTree& guide_;
  const BoxesNear& boxes_;
  std::vector<std::uint32_t> end_;  // for each of the guide's nodes, the end of its leaves
  Buckets by_leaf_;
  std::vector<Size> size_;  // for each node that divides
  TriangleTree tree_;
  tbb::enumerable_thread_specific<Divider> dividers_;
};

}  // namespace

TriangleTree make_tree_along(const TriangleTree& guide, const BoxesNear& boxes) {
  return boxes.count == 0 ? TriangleTree{} : Along(guide, boxes).make();
}

}  // namespace penumbra::visibility
