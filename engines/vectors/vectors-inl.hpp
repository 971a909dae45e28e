// SPDX-License-Identifier: Apache-2.0
// Vectors of floats of the processor's width: included once for each target by each stage of a method on the processor.
// Inside engines/vectors/ only, and in the stages of methods.

#if defined(PENUMBRA_VECTORS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VECTORS_INL_HPP
#undef PENUMBRA_VECTORS_INL_HPP
#else
#define PENUMBRA_VECTORS_INL_HPP
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using I = hn::RebindToSigned<D>;

[[maybe_unused]] V set(float x) {
  return hn::Set(D(), x);
}
[[maybe_unused]] V bits(std::uint32_t x) {
  return hn::BitCast(D(), hn::Set(hn::RebindToUnsigned<D>(), x));
}
[[maybe_unused]] M same_bits(V x, V y) {
  const hn::RebindToUnsigned<D> words;
  const auto equal = hn::Eq(hn::BitCast(words, x), hn::BitCast(words, y));
  return hn::MaskFromVec(hn::BitCast(D(), hn::VecFromMask(words, equal)));
}
[[maybe_unused]] M first_lanes(std::size_t count) {
  return hn::FirstN(D(), count);
}

/// Returns first, first + 1, …. Only Highway's Iota from 0 is a constant; others go lane by lane through memory.
[[maybe_unused]] hn::Vec<I> numbers_from(std::size_t first) {
  return hn::Add(hn::Iota(I(), 0), hn::Set(I(), static_cast<std::int32_t>(first)));
}

/// Calls `visit(lane)` for each set lane.
template <typename Visit>
void for_each_lane(M which, Visit visit) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(D(), which, bytes);
  for (std::size_t lane = 0; lane < hn::Lanes(D()); ++lane) {
    if ((bytes[lane / 8] >> (lane % 8) & 1) != 0) visit(lane);
  }
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
