// SPDX-License-Identifier: Apache-2.0
// Selection of the smallest items along an axis, by counting on vector units.

#include "visibility/tree/halves.hpp"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/tree/halves.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::visibility::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Counts, for each of the first `count` keys, how many keys are smaller. Keys and counts must be padded to whole
/// vectors.
void count_below(const std::int32_t* keys, std::size_t count, std::int32_t* below) {
  const hn::CappedTag<std::int32_t, 16> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto own = hn::Load(d, keys + i);
    auto sum = hn::Zero(d);  // a mask is −1
    for (std::size_t j = 0; j < count; ++j) sum = hn::Sub(sum, hn::VecFromMask(d, hn::Lt(hn::Set(d, keys[j]), own)));
    hn::Store(sum, d, below + i);
  }
}

}  // namespace
}  // namespace penumbra::visibility::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::visibility {
namespace {

HWY_EXPORT(count_below);

/// For at most this many items, ranks are counted by comparing every item with every other: on vector units that is
/// faster than a search for the median with its branches.
constexpr std::size_t kCounted = 64;

}  // namespace

void put_least_first(std::span<Divided> items, std::size_t first, int axis, float lower, float upper) {
  if (items.size() > kCounted) {
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(first), items.end(),
                     [&](const Divided& x, const Divided& y) {
                       return x.middle[axis] != y.middle[axis] ? x.middle[axis] < y.middle[axis] : x.at < y.at;
                     });
    return;
  }
  // A key is the item's step along the axis, and in the bits below that its index, so that all keys differ.
  constexpr std::int32_t kSteps = 1 << 24;
  alignas(64) std::array<std::int32_t, kCounted> keys, below;
  const double steps = upper > lower ? kSteps / (static_cast<double>(upper) - lower) : 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto step = static_cast<std::int32_t>((static_cast<double>(items[i].middle[axis]) - lower) * steps);
    keys[i] = std::min(step, kSteps - 1) * static_cast<std::int32_t>(kCounted) + static_cast<std::int32_t>(i);
  }
  std::fill(keys.begin() + static_cast<std::ptrdiff_t>(items.size()), keys.end(), 0);
  HWY_DYNAMIC_DISPATCH(count_below)(keys.data(), items.size(), below.data());
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

}  // namespace penumbra::visibility
#endif
