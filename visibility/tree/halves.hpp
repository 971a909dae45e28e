// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

/// Division of the last boxes of a tree, where the surface area heuristic gives no information. Inside visibility/tree/
/// only.
namespace penumbra::visibility {

/// A box to be divided: its middle, or twice that, and its index.
struct Divided {
  glm::vec3 middle;
  std::uint32_t at;
};

/// Moves the `first` smallest items along an axis to the front. Items extend from `lower` to `upper`; differences below
/// 2⁻²⁴ of that may be ignored, which does not affect the tree's quality. Equal items keep their order.
void put_least_first(std::span<Divided> items, std::size_t first, int axis, float lower, float upper);

/// Divides the items in halves along the longest side of the middles' bounds, again and again, and calls take(part)
/// with parts of `step` items, of which the last may have fewer.
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
