#include "visibility/tree/tree_along.hpp"

#include "base/assert.hpp"
#include "base/buckets.hpp"
#include "base/parallel.hpp"
#include "visibility/tree/halves.hpp"

#include <glm/common.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace penumbra::visibility {
namespace {

using Child = TriangleTree::Child;

constexpr std::size_t kWidth = TriangleTree::kWidth;
constexpr std::size_t kTogether = kWidth * kWidth;    // of so many boxes and fewer the guide says nothing
constexpr std::size_t kPart = std::size_t{1} << 13U;  // boxes worth a task of their own

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

/// Adds to a tree from its leaves upward.
class Maker {
 public:
  explicit Maker(const BoxesNear& boxes) : all_(&boxes) {}

  /// A node of the children that `fill` gives to a function.
  template <typename Fill>
  Child node(std::uint32_t depth, const Fill& fill) {
    const auto number = static_cast<std::uint32_t>(tree.nodes.size());
    tree.nodes.emplace_back();
    tree.depth = std::max(tree.depth, depth);
    std::size_t count = 0;
    Bounds all = nothing();
    fill([&](const Child& child) {
      if (child.reference == TriangleTree::kNoChild) return;
      tree.nodes[number][count++] = child;
      include(all, {child.lower, child.upper});
    });
    return {all.lower, all.upper, number};
  }

  /// Of these boxes alone.
  Child divide(std::span<const std::uint32_t> numbers, std::uint32_t depth) {
    numbers_ = numbers;
    boxes_.clear();
    items_.clear();
    for (const std::uint32_t number : numbers) {
      const Bounds& box = boxes_.emplace_back(all_->box(number));
      items_.push_back({box.lower + box.upper, static_cast<std::uint32_t>(items_.size())});
    }
    return divide(std::span(items_), depth);
  }

  /// What another maker made.
  Child append(const TriangleTree& more, const Child& root) {
    const auto first_node = static_cast<std::uint32_t>(tree.nodes.size()),
               first_leaf = static_cast<std::uint32_t>(tree.leaves.size());
    const auto moved = [&](Child child) {
      if (child.reference != TriangleTree::kNoChild)
        child.reference += is_leaf(child.reference) ? first_leaf : first_node;
      return child;
    };
    for (TriangleTree::Node node : more.nodes) {
      for (Child& child : node) child = moved(child);
      tree.nodes.push_back(node);
    }
    tree.leaves.insert(tree.leaves.end(), more.leaves.begin(), more.leaves.end());
    tree.depth = std::max(tree.depth, more.depth);
    return moved(root);
  }

  TriangleTree tree;

 private:
  /// Parts of eight times eight times … items, so that all leaves but the last are full.
  Child divide(std::span<Divided> items, std::uint32_t depth) {
    if (items.size() <= kWidth) return leaf(items);
    std::size_t step = kWidth;
    while (step * kWidth < items.size()) step *= kWidth;
    return node(depth, [&](const auto& add) {
      halve(items, step, [&](std::span<Divided> part) { add(divide(part, depth + 1)); });
    });
  }

  Child leaf(std::span<const Divided> items) {
    TriangleTree::Leaf slots;
    slots.fill(TriangleTree::kNoTriangle);
    Bounds all = nothing();
    for (std::size_t i = 0; i < items.size(); ++i) {
      slots[i] = numbers_[items[i].at];
      include(all, boxes_[items[i].at]);
    }
    std::sort(slots.begin(), slots.end());  // kNoTriangle is the largest
    tree.leaves.push_back(slots);
    return {all.lower, all.upper, static_cast<std::uint32_t>(tree.leaves.size() - 1) | TriangleTree::kLeafBit};
  }

  const BoxesNear* all_;
  std::span<const std::uint32_t> numbers_;  // of what is divided
  std::vector<Bounds> boxes_;
  std::vector<Divided> items_;
};

class Along {
 public:
  Along(const TriangleTree& guide, const BoxesNear& boxes) : guide_(guide), boxes_(boxes), end_(guide.nodes.size()) {
    static_cast<void>(find_end(0, 0));
    std::uint32_t most = 0;
    for (const TriangleTree::Leaf& leaf : guide.leaves) {
      for (const std::uint32_t triangle : leaf)
        most = triangle < TriangleTree::kNoTriangle ? std::max(most, triangle) : most;
    }
    std::vector<std::uint32_t> leaf_of(std::size_t{most} + 1, TriangleTree::kNoTriangle);
    mesh::for_each_index(guide.leaves.size(), [&](std::size_t leaf) {
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
    find_parts(whole);
    std::vector<Maker> makers(parts_.size(), Maker(boxes_));
    std::vector<Child> roots(parts_.size());
    tbb::parallel_for(std::size_t{0}, parts_.size(), [&](std::size_t i) {
      roots[i] = below(parts_[i], parts_[i].depth, makers[i], [](const Part&) { return std::optional<Child>(); });
    });
    Maker all(boxes_);
    std::size_t next = 0;
    const Child root = below(whole, 1, all, [&](const Part& part) -> std::optional<Child> {
      if (next == parts_.size() || !(part == parts_[next])) return std::nullopt;
      const Child made = all.append(makers[next].tree, roots[next]);
      makers[next++].tree = {};
      return made;
    });
    if (is_leaf(root.reference)) all.node(1, [&](const auto& add) { add(root); });
    return std::move(all.tree);
  }

 private:
  /// What hangs below one of the guide's nodes or is one of its leaves: leaves from `first` on.
  struct Part {
    std::uint32_t reference, first;
    std::uint32_t depth = 1;  // of its root

    bool operator==(const Part& other) const { return reference == other.reference; }
  };

  /// The leaves below a node follow one another; where those below this one end.
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
      const Part one{child.reference, first, part.depth + 1};
      visit(one);
      first = end_of(one);
    }
  }

  /// Only leaves are below, or it is one.
  [[nodiscard]] bool is_last(std::uint32_t reference) const {
    return is_leaf(reference) || std::ranges::all_of(guide_.nodes[reference], [](const Child& child) {
             return child.reference == TriangleTree::kNoChild || is_leaf(child.reference);
           });
  }

  void find_parts(const Part& part) {
    const std::size_t count = boxes_of(part).size();
    if (count == 0) return;
    if (count <= kPart || is_leaf(part.reference)) {
      parts_.push_back(part);
    } else {
      for_each_child(part, [&](const Part& child) { find_parts(child); });
    }
  }

  /// `made`: what is there already.
  template <typename Made>
  Child below(const Part& part, std::uint32_t depth, Maker& maker, const Made& made) const {
    const std::span<const std::uint32_t> numbers = boxes_of(part);
    if (numbers.empty()) return {};
    if (const std::optional<Child> there = made(part)) return *there;
    if (numbers.size() > kTogether && !is_last(part.reference)) {
      return maker.node(depth, [&](const auto& add) {
        for_each_child(part, [&](const Part& child) { add(below(child, depth + 1, maker, made)); });
      });
    }
    return maker.divide(numbers, depth);
  }

  const TriangleTree& guide_;
  const BoxesNear& boxes_;
  std::vector<std::uint32_t> end_;  // of each of the guide's nodes
  Buckets by_leaf_;
  std::vector<Part> parts_;
};

}  // namespace

TriangleTree make_tree_along(const TriangleTree& guide, const BoxesNear& boxes) {
  return boxes.count == 0 ? TriangleTree{} : Along(guide, boxes).make();
}

}  // namespace penumbra::visibility
