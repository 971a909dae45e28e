// SPDX-License-Identifier: Apache-2.0
// Tests whether edges or triangles may meet the hull of view samples and the light. Inside engines/vectors/ only, and
// in the stages of methods.

#if defined(PENUMBRA_VECTORS_HULL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VECTORS_HULL_INL_HPP
#undef PENUMBRA_VECTORS_HULL_INL_HPP
#else
#define PENUMBRA_VECTORS_HULL_INL_HPP
#endif

#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/vectors-inl.hpp"

#include <array>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// One corner of a vector of edges or triangles, in the grid's axes relative to the cluster's middle.
struct Corners {
  V across, along, height;
};

/// Returns the edges or triangles whose corners are not all beyond one of the hull's faces.
template <std::size_t kCount>
M meets(const Hull& hull, const std::array<Corners, kCount>& corners) {
  V low = corners[0].height, high = low;
  for (std::size_t i = 1; i < kCount; ++i) {
    low = hn::Min(low, corners[i].height);
    high = hn::Max(high, corners[i].height);
  }
  M met = hn::And(hn::Le(low, set(hull.highest)), hn::Ge(high, set(hull.lowest)));
  for (std::size_t face = 0; face < 4; ++face) {
    V least = set(3e38F);
    for (const Corners& corner : corners) {
      const V x = face < 2 ? corner.across : corner.along;
      least = hn::Min(least, hn::NegMulAdd(set(hull.slope[face]), corner.height, face % 2 == 0 ? x : hn::Neg(x)));
    }
    met = hn::And(met, hn::Le(least, set(hull.beyond[face])));
  }
  return met;
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
