// SPDX-License-Identifier: Apache-2.0
// Minimum of a list of doubles, on vector units.

#include "volumes/scatter/vectors/first_least.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/scatter/vectors/first_least.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

FirstLeast first_least_here(std::span<const double> numbers) {
  const hn::CappedTag<double, kRoom> d;
  const std::size_t count = numbers.size() - kRoom;
  auto least = hn::Set(d, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) least = hn::Min(least, hn::LoadU(d, &numbers[i]));
  least = hn::MinOfLanes(d, least);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto lane = hn::FindFirstTrue(d, hn::Eq(hn::LoadU(d, &numbers[i]), least));
    if (lane >= 0) return {hn::GetLane(least), i + static_cast<std::size_t>(lane)};
  }
  return {};
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(first_least_here);

FirstLeast first_least(std::span<const double> numbers) {
  return HWY_DYNAMIC_DISPATCH(first_least_here)(numbers);
}

}  // namespace penumbra::volumes
#endif
