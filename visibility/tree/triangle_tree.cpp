// SPDX-License-Identifier: Apache-2.0
// Builds an eight-wide bounding volume hierarchy by the binned surface area heuristic: I. Wald, On fast construction of
// SAH-based bounding volume hierarchies, 2007; eight children as in Wald, Benthin, Boulos, Getting rid of packets,
// 2008: the largest child is divided until there are eight. The divided items are groups of neighbouring boxes
// (box_groups.hpp), and the last dozens are divided in halves.

#include "visibility/tree/triangle_tree.hpp"

#include "base/parallel.hpp"
#include "visibility/tree/box_around.hpp"
#include "visibility/tree/box_groups.hpp"
#include "visibility/tree/halves.hpp"

#include <glm/common.hpp>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <limits>
#include <list>
#include <mutex>
#include <utility>

namespace penumbra::visibility {
namespace {

constexpr std::uint32_t kWidth = TriangleTree::kWidth;

/// For at most this many boxes the heuristic is not worth its time: they get one node, whose leaves are full. Their
/// edges, 1.5 times as many, fill one node of a tree over edges (tree_along.cpp).
constexpr std::uint32_t kTogether = 5 * kWidth;

/// Below this depth, groups are halved regardless of their shape: this bounds the tree's depth.
constexpr std::uint32_t kDeep = 24;

constexpr std::uint32_t kTask = 1U << 13U;  // boxes that justify a separate task

/// Consecutive groups.
struct Range {
  std::span<BoxGroup> groups;
  std::uint32_t boxes = 0;
  BoxAround box;

  [[nodiscard]] bool is_last() const { return boxes <= kTogether; }
};

Range range_of(std::span<BoxGroup> groups) {
  Range range{groups, 0, {}};
  for (const BoxGroup& group : groups) {
    range.boxes += group.count;
    range.box.include(group);
  }
  return range;
}

/// Returns the cost of a division: boxes are tested in blocks of eight, as often as a ray meets their bounds.
double cost(double area, std::uint32_t boxes) {
  const std::uint32_t blocks = (boxes + kWidth - 1) / kWidth;
  return area * blocks;
}

/// The cheapest division of groups found so far.
struct Division {
  double cost = std::numeric_limits<double>::infinity();
  std::uint32_t uneven = 0;  // at equal costs, the division with the more even halves wins
  int axis = -1;
  std::size_t bin = 0;       // first bin of the second half
  std::uint32_t groups = 0;  // groups of the first half
  std::array<std::uint32_t, 2> boxes{};
  std::array<BoxAround, 2> box;
};

/// Slabs of equal width along each axis, and the groups with their middles in each.
class Bins {
 public:
  explicit Bins(const Range& range) : count_(std::clamp<std::size_t>(range.groups.size(), 4, kMost)) {
    BoxAround middles;
    for (const BoxGroup& group : range.groups) middles.include(group.middle());
    const glm::dvec3 extent = glm::dvec3(middles.upper()) - glm::dvec3(middles.lower());
    lower_ = middles.lower();
    for (int axis = 0; axis < 3; ++axis) {
      slabs_[axis] = extent[axis] > 0 ? static_cast<double>(count_) / extent[axis] : 0;
      std::fill_n(bins_[static_cast<std::size_t>(axis)].begin(), count_, Bin{});
    }
    for (const BoxGroup& group : range.groups) {
      for (int axis = 0; axis < 3; ++axis) {
        Bin& bin = bins_[static_cast<std::size_t>(axis)][bin_of(group, axis)];
        bin.box.include(group);
        bin.boxes += group.count;
        ++bin.groups;
      }
    }
  }
  [[nodiscard]] std::size_t bin_of(const BoxGroup& group, int axis) const {
    const double middle = 0.5F * group.lower[axis] + 0.5F * group.upper[axis];
    return std::min(static_cast<std::size_t>((middle - lower_[axis]) * slabs_[axis]), count_ - 1);
  }
  /// Returns the best division; axis < 0: all middles are equal.
  [[nodiscard]] Division best(const Range& range) const {
    Division best;
    for (int axis = 0; axis < 3; ++axis) {
      if (slabs_[axis] > 0) find_better(range, axis, best);
    }
    return best;
  }

 private:
  static constexpr std::size_t kMost = 32;
  struct Bin {
    BoxAround box;
    std::uint32_t boxes = 0, groups = 0;
  };

  void find_better(const Range& range, int axis, Division& best) const {
    const std::array<Bin, kMost>& bins = bins_[static_cast<std::size_t>(axis)];
    std::array<double, kMost> areas;  // areas from each slab on
    BoxAround box;
    for (std::size_t i = count_; i-- > 1;) {
      box.include(bins[i].box);
      areas[i] = box.area();
    }
    box = {};
    std::uint32_t boxes = 0, groups = 0;
    bool is_better = false;
    for (std::size_t i = 1; i < count_; ++i) {
      if (bins[i - 1].groups == 0) continue;  // same division as before
      box.include(bins[i - 1].box);
      boxes += bins[i - 1].boxes;
      groups += bins[i - 1].groups;
      if (boxes == range.boxes) break;
      const double costs = cost(box.area(), boxes) + cost(areas[i], range.boxes - boxes);
      const std::uint32_t uneven = std::max(boxes, range.boxes - boxes);
      if (costs > best.cost || (costs == best.cost && uneven >= best.uneven)) continue;
      best = {costs, uneven, axis, i, groups, {boxes, range.boxes - boxes}, {box, {}}};
      is_better = true;
    }
    if (!is_better) return;
    for (std::size_t i = best.bin; i < count_; ++i) best.box[1].include(bins[i].box);
  }

  std::size_t count_;
  glm::dvec3 lower_{0}, slabs_{0};  // slabs in a unit of length
  std::array<std::array<Bin, kMost>, 3> bins_;
};

using Halves = std::array<Range, 2>;

Halves in_the_middle(const Range& range) {
  const std::size_t half = range.groups.size() / 2;
  return {range_of(range.groups.first(half)), range_of(range.groups.subspan(half))};
}

/// Divides at least two groups.
Halves divided(const Range& range) {
  const Bins bins(range);
  const Division best = bins.best(range);
  if (best.axis < 0) return in_the_middle(range);  // all at one place
  std::partition(range.groups.begin(), range.groups.end(),
                 [&](const BoxGroup& group) { return bins.bin_of(group, best.axis) < best.bin; });
  return {Range{range.groups.first(best.groups), best.boxes[0], best.box[0]},
          Range{range.groups.subspan(best.groups), best.boxes[1], best.box[1]}};
}

/// A node with its subtree, before it is placed: numbers of nodes and leaves, including itself.
struct Planned {
  Range range;
  std::uint32_t nodes = 0, leaves = 0, depth = 0;
  std::vector<Planned> children;  // empty: at most kTogether boxes

  [[nodiscard]] bool is_leaf() const { return nodes == 0; }
};

class Builder {
 public:
  explicit Builder(std::span<NumberedBox> boxes) : boxes_(boxes) {}

  [[nodiscard]] Planned plan(const Range& range, std::uint32_t depth) {
    Planned planned{range, 0, 0, 0, {}};
    if (range.is_last()) {
      planned.leaves = (range.boxes + kWidth - 1) / kWidth;
      planned.nodes = planned.depth = planned.leaves > 1 ? 1 : 0;
      return planned;
    }
    std::array<Range, kWidth> parts{range};
    std::size_t count = 1;
    while (count < kWidth) {
      const auto largest = std::max_element(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count),
                                            [&](const Range& a, const Range& b) { return before(a, b, depth); });
      if (largest->is_last()) break;
      auto [first, second] = halves(*largest, depth);
      *largest = first;
      parts[count++] = second;
    }
    planned.children.resize(count);
    const auto below = [&](std::size_t i) { planned.children[i] = plan(parts[i], depth + 1); };
    if (range.boxes > kTask) {
      tbb::task_group tasks;
      for (std::size_t i = 0; i < count; ++i) tasks.run([&, i] { below(i); });
      tasks.wait();
    } else {
      for (std::size_t i = 0; i < count; ++i) below(i);
    }
    planned.nodes = 1;
    for (const Planned& child : planned.children) {
      planned.nodes += child.nodes;
      planned.leaves += child.leaves;
      planned.depth = std::max(planned.depth, child.depth);
    }
    ++planned.depth;
    return planned;
  }

  /// Places nodes depth first, so that the leaves below a node are contiguous.
  void place(const Planned& planned, std::uint32_t number, std::uint32_t first_leaf) {
    TriangleTree::Node& node = tree.nodes[number] = {};
    if (planned.children.empty()) return place_leaves(planned, node, first_leaf);
    tbb::task_group tasks;
    std::uint32_t next_node = number + 1, next_leaf = first_leaf;
    for (std::size_t i = 0; i < planned.children.size(); ++i) {
      const Planned& child = planned.children[i];
      const BoxAround& box = child.range.box;
      if (child.is_leaf()) {
        TriangleTree::Node alone;
        place_leaves(child, alone, next_leaf);
        node[i] = alone[0];
      } else {
        node[i] = {box.lower(), box.upper(), next_node};
        const auto below = [this, &child, next_node, next_leaf] { place(child, next_node, next_leaf); };
        if (child.range.boxes > kTask)
          tasks.run(below);
        else
          below();
      }
      next_node += child.nodes;
      next_leaf += child.leaves;
    }
    tasks.wait();
  }

  TriangleTree tree;

 private:
  /// Returns whether a is divided later than b.
  [[nodiscard]] static bool before(const Range& a, const Range& b, std::uint32_t depth) {
    if (a.is_last() != b.is_last()) return a.is_last();
    const double area_a = depth < kDeep ? a.box.area() : 0, area_b = depth < kDeep ? b.box.area() : 0;
    return area_a != area_b ? area_a < area_b : a.boxes < b.boxes;
  }

  [[nodiscard]] Halves halves(const Range& range, std::uint32_t depth) {
    if (range.groups.size() == 1) {
      const BoxGroup& one = range.groups.front();
      std::vector<BoxGroup> groups = group_again(boxes_.subspan(one.first, one.count));
      for (BoxGroup& group : groups) group.first += one.first;
      return halves({keep(std::move(groups)), range.boxes, range.box}, depth);
    }
    return depth < kDeep ? divided(range) : in_the_middle(range);
  }
  std::span<BoxGroup> keep(std::vector<BoxGroup> groups) {
    const std::scoped_lock lock(mutex_);
    return grouped_again_.emplace_back(std::move(groups));
  }

  /// Places leaves of at most kTogether boxes, as children of a node.
  void place_leaves(const Planned& planned, TriangleTree::Node& node, std::uint32_t next_leaf) {
    std::array<Divided, kTogether> items;
    std::array<const NumberedBox*, kTogether> boxes;
    std::uint32_t count = 0;
    for (const BoxGroup& group : planned.range.groups) {
      for (const NumberedBox& box : boxes_.subspan(group.first, group.count)) {
        items[count] = {box.middle(), count};
        boxes[count++] = &box;
      }
    }
    std::size_t children = 0;
    halve(std::span(items).first(count), kWidth, [&](std::span<const Divided> part) {
      TriangleTree::Leaf& leaf = tree.leaves[next_leaf];
      leaf.fill(TriangleTree::kNoTriangle);
      BoxAround all;
      for (std::size_t i = 0; i < part.size(); ++i) {
        const NumberedBox& box = *boxes[part[i].at];
        leaf[i] = box.number;
        all.include(box);
      }
      std::sort(leaf.begin(), leaf.begin() + static_cast<std::ptrdiff_t>(part.size()));
      node[children++] = {all.lower(), all.upper(), TriangleTree::kLeafBit | next_leaf++};
    });
  }

  std::span<NumberedBox> boxes_;
  std::mutex mutex_;
  std::list<std::vector<BoxGroup>> grouped_again_;
};

TriangleTree make_tree(std::size_t count, const std::function<NumberedBox(std::size_t)>& box) {
  if (count == 0) return {};
  GroupedBoxes grouped = group_boxes(count, box);
  Builder builder({grouped.boxes.get(), count});
  const Planned root = builder.plan(range_of(grouped.groups), 0);
  TriangleTree& tree = builder.tree;
  tree.leaves.resize(root.leaves);
  tree.nodes.resize(std::max(root.nodes, 1U));
  tree.depth = std::max(root.depth, 1U);
  builder.place(root, 0, 0);
  return std::move(tree);
}

}  // namespace

TriangleTree make_triangle_tree(const SceneFloats& scene) {
  std::vector<std::uint32_t> casters;
  casters.reserve(scene.triangles.size());
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.casts_shadow[i] != 0) casters.push_back(i);
  }
  return make_tree(casters.size(), [&](std::size_t i) -> NumberedBox {
    const auto [a, b, c] = scene.corners(casters[i]);
    return {glm::min(a, glm::min(b, c)), casters[i], glm::max(a, glm::max(b, c)), 0};
  });
}

TriangleTree make_tree_over(std::span<const Bounds> boxes) {
  return make_tree(boxes.size(), [&](std::size_t i) -> NumberedBox {
    return {boxes[i].lower, static_cast<std::uint32_t>(i), boxes[i].upper, 0};
  });
}

}  // namespace penumbra::visibility
