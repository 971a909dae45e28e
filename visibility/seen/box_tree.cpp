#include "visibility/seen/box_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

namespace penumbra::visibility {

BoxTree::BoxTree(std::span<const MiddleBox> boxes, std::uint32_t most) {
  if (boxes.empty()) return;
  items_.resize(boxes.size());
  std::iota(items_.begin(), items_.end(), 0U);
  nodes_.reserve(4 * boxes.size() / most + 1);
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()), most);
  nodes_.shrink_to_fit();
}

std::uint32_t BoxTree::build(std::span<const MiddleBox> boxes, std::uint32_t first, std::uint32_t count,
                             std::uint32_t most) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  glm::dvec3 lower(kEndless), upper(-kEndless), least(kEndless), greatest(-kEndless);
  const auto mine = std::span(items_).subspan(first, count);
  for (const std::uint32_t item : mine) {
    const auto& [middle, half] = boxes[item];
    lower = glm::min(lower, middle - half), upper = glm::max(upper, middle + half);
    least = glm::min(least, middle), greatest = glm::max(greatest, middle);
  }
  // Half sides are rounded outward: a sum and a difference of two numbers, each with a relative error of 2⁻⁵³.
  const glm::dvec3 room = 0x1p-50 * (glm::abs(lower) + glm::abs(upper));
  nodes_[number].box = {0.5 * (lower + upper), 0.5 * (upper - lower) + room};
  if (count <= most) {
    nodes_[number].first = first;
    nodes_[number].count = count;
    return number;
  }
  const glm::dvec3 extent = greatest - least;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  std::ranges::nth_element(mine, mine.begin() + half, [&](std::uint32_t a, std::uint32_t b) {
    const double x = boxes[a].middle[axis], y = boxes[b].middle[axis];
    return x != y ? x < y : a < b;
  });
  build(boxes, first, half, most);
  const std::uint32_t second = build(boxes, first + half, count - half, most);
  nodes_[number].first = second;
  return number;
}

double BoxTree::leaf_size() const {
  double sum = 0;
  std::size_t leaves = 0;
  for (const Node& node : nodes_) {
    if (node.count == 0) continue;
    sum += node.box.half.x + node.box.half.y + node.box.half.z;
    ++leaves;
  }
  return leaves == 0 ? 0 : sum / static_cast<double>(leaves);
}

}  // namespace penumbra::visibility
