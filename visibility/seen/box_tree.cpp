// SPDX-License-Identifier: Apache-2.0
// Builds a binary hierarchy over boxes: nodes are divided at one of sixteen slices by the surface area heuristic, and
// in halves far below the root or where all middles coincide.

#include "visibility/seen/box_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

namespace penumbra::visibility {
namespace {

constexpr std::size_t kSlices = 16;
/// Depth from which on nodes are halved: 2³² boxes then need 32 more levels.
constexpr std::uint32_t kSlicedDepth = BoxTree::kDepth - 34;

/// Boxes of a slice, or of several.
struct Slice {
  glm::dvec3 lower{std::numeric_limits<double>::infinity()}, upper = -lower;
  std::uint32_t count = 0;

  void add(const Slice& other) {
    lower = glm::min(lower, other.lower), upper = glm::max(upper, other.upper);
    count += other.count;
  }
  /// Half of the box's surface, times the number of boxes in it.
  [[nodiscard]] double cost() const {
    if (count == 0) return 0;
    const glm::dvec3 side = upper - lower;
    return (side.x * side.y + side.y * side.z + side.z * side.x) * count;
  }
};

/// Position at which a node is divided: between two slices along an axis.
struct Cut {
  double cost = std::numeric_limits<double>::infinity();
  int axis = -1;
  std::size_t slice = 0;  ///< the first of the second part
};

std::size_t slice_of(double middle, double least, double width) {
  return static_cast<std::size_t>(std::clamp((middle - least) / width, 0.0, kSlices - 1.0));
}

/// Replaces `best` by the axis's best cut, if that is better.
void find_cut(std::span<const MiddleBox> boxes, std::span<const std::uint32_t> mine, int axis, double least,
              double width, Cut& best) {
  std::array<Slice, kSlices> slices;
  for (const std::uint32_t item : mine) {
    const auto& [middle, half] = boxes[item];
    slices[slice_of(middle[axis], least, width)].add({middle - half, middle + half, 1});
  }
  std::array<double, kSlices> after{};  // cost of this slice and all that follow
  Slice all;
  for (std::size_t i = kSlices; i-- > 1;) {
    all.add(slices[i]);
    after[i] = all.cost();
  }
  Slice before;
  for (std::size_t i = 1; i < kSlices; ++i) {
    before.add(slices[i - 1]);
    const double cost = before.cost() + after[i];
    if (before.count > 0 && before.count < mine.size() && cost < best.cost) best = {cost, axis, i};
  }
}

}  // namespace

BoxTree::BoxTree(std::span<const MiddleBox> boxes, std::uint32_t most) {
  if (boxes.empty()) return;
  items_.resize(boxes.size());
  std::iota(items_.begin(), items_.end(), 0U);
  nodes_.reserve(4 * boxes.size() / most + 1);
  build(boxes, {0, static_cast<std::uint32_t>(boxes.size()), 0}, most);
  nodes_.shrink_to_fit();
}

std::uint32_t BoxTree::build(std::span<const MiddleBox> boxes, const Range& range, std::uint32_t most) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  glm::dvec3 lower(kEndless), upper(-kEndless), least(kEndless), greatest(-kEndless);
  for (const std::uint32_t item : std::span(items_).subspan(range.first, range.count)) {
    const auto& [middle, half] = boxes[item];
    lower = glm::min(lower, middle - half), upper = glm::max(upper, middle + half);
    least = glm::min(least, middle), greatest = glm::max(greatest, middle);
  }
  // Half sides are rounded outward: a sum and a difference of two numbers, each with a relative error of 2⁻⁵³.
  const glm::dvec3 room = 0x1p-50 * (glm::abs(lower) + glm::abs(upper));
  nodes_[number].box = {0.5 * (lower + upper), 0.5 * (upper - lower) + room};
  if (range.count <= most) {
    nodes_[number].first = range.first;
    nodes_[number].count = range.count;
    return number;
  }
  const std::uint32_t half = divide(boxes, range, least, greatest);
  build(boxes, {range.first, half, range.depth + 1}, most);
  const std::uint32_t second = build(boxes, {range.first + half, range.count - half, range.depth + 1}, most);
  nodes_[number].first = second;
  return number;
}

/// Sorts the items of the first part before those of the second. Returns the number of the first part's items.
std::uint32_t BoxTree::divide(std::span<const MiddleBox> boxes, const Range& range, const glm::dvec3& least,
                              const glm::dvec3& greatest) {
  const auto mine = std::span(items_).subspan(range.first, range.count);
  const glm::dvec3 extent = greatest - least, width = extent / static_cast<double>(kSlices);
  Cut cut;
  for (int axis = 0; axis < 3 && range.depth < kSlicedDepth; ++axis) {
    if (width[axis] > 0) find_cut(boxes, mine, axis, least[axis], width[axis], cut);
  }
  if (cut.axis >= 0) {
    const auto is_before = [&](std::uint32_t item) {
      return slice_of(boxes[item].middle[cut.axis], least[cut.axis], width[cut.axis]) < cut.slice;
    };
    return static_cast<std::uint32_t>(std::stable_partition(mine.begin(), mine.end(), is_before) - mine.begin());
  }
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t half = range.count / 2;
  std::ranges::nth_element(mine, mine.begin() + half, [&](std::uint32_t a, std::uint32_t b) {
    const double x = boxes[a].middle[axis], y = boxes[b].middle[axis];
    return x != y ? x < y : a < b;
  });
  return half;
}

}  // namespace penumbra::visibility
