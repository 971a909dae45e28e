#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
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

/// Of so many items and fewer the place of each is counted, each against each, which vector units do faster than a
/// search for the median goes from branch to branch.
constexpr std::size_t kCounted = 64;

/// How many of the first kPadded keys, a multiple of what vector units compare at once, are below each.
template <std::size_t kPadded>
void count_below(const std::array<std::int32_t, kCounted>& keys, std::array<std::int32_t, kCounted>& below) {
  for (std::size_t i = 0; i < kPadded; ++i) {
    std::int32_t sum = 0;
    for (std::size_t j = 0; j < kPadded; ++j) sum += keys[j] < keys[i] ? 1 : 0;
    below[i] = sum;
  }
}

/// Puts the `first` that are least along an axis, which they reach from `lower` to `upper`, before all others: to 2⁻²⁴
/// of that, which no tree notices. Equal ones keep their order.
inline void put_least_first(std::span<Divided> items, std::size_t first, int axis, float lower, float upper) {
  if (items.size() > kCounted) {
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(first), items.end(),
                     [&](const Divided& x, const Divided& y) {
                       return x.middle[axis] != y.middle[axis] ? x.middle[axis] < y.middle[axis] : x.at < y.at;
                     });
    return;
  }
  constexpr std::int32_t kSteps = 1 << 24;  // and below each as many places as there may be
  std::array<std::int32_t, kCounted> keys, below;
  keys.fill(std::numeric_limits<std::int32_t>::max());
  const double steps = upper > lower ? kSteps / (static_cast<double>(upper) - lower) : 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto step = static_cast<std::int32_t>((static_cast<double>(items[i].middle[axis]) - lower) * steps);
    keys[i] = std::min(step, kSteps - 1) * static_cast<std::int32_t>(kCounted) + static_cast<std::int32_t>(i);
  }
  if (items.size() <= 16)
    count_below<16>(keys, below);
  else if (items.size() <= 32)
    count_below<32>(keys, below);
  else
    count_below<kCounted>(keys, below);
  std::array<Divided, kCounted> sorted;
  std::size_t least = 0, others = first;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool is_least = below[i] < static_cast<std::int32_t>(first);
    sorted[is_least ? least : others] = items[i];
    least += is_least ? 1 : 0;
    others += is_least ? 0 : 1;
  }
  std::copy_n(sorted.begin(), items.size(), items.begin());
}

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
