#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

/// Dividing the last boxes of a tree, where the surface area heuristic says nothing. Inside visibility/tree/ only.
namespace penumbra::visibility {

/// A box that is divided: its middle, or twice that, and which one it is.
struct Divided {
  glm::vec3 middle;
  std::uint32_t at;
};

/// Puts the `first` that are least along an axis, which they reach from `lower` to `upper`, before all others: to 2⁻²⁴
/// of that, which no tree notices. Equal ones keep their order.
void put_least_first(std::span<Divided> items, std::size_t first, int axis, float lower, float upper);

/// Calls take(part) with parts of `step` items, the last may have fewer: halves along the longest side of middles.
template <typename Take>
void halve(std::span<Divided> items, std::size_t step, const Take& take) {
  const std::size_t parts = (items.size() + step - 1) / step, first = parts / 2 * step;
  if (parts <= 1) return take(items);
  glm::vec3 lower(std::numeric_limits<float>::infinity()), upper = -lower;
  for (const Divided& item : items) lower = glm::min(lower, item.middle), upper = glm::max(upper, item.middle);
  const glm::vec3 extent = upper - lower;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  put_least_first(items, first, axis, lower[axis], upper[axis]);
  halve(items.first(first), step, take);
  halve(items.subspan(first), step, take);
}

}  // namespace penumbra::visibility
