// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "selftest/check.hpp"
#include "selftest/small_scenes.hpp"
#include "visibility/method.hpp"
#include "volumes/counters/depth_counters.hpp"

#include <cstddef>
#include <string>

namespace penumbra::selftest {

/// Compares every bit of an exact method's masks with visibility::decide_pair (exact predicates on the stored floats):
/// covers all passes of the method.
Check check_masks(visibility::Method& method, const Stage& stage, const std::string& name);

/// Counts of the cases in a check of counters: all pairs; among these, pairs without a counter, pairs that meet any
/// triangle, and pairs that meet several.
struct CounterTally {
  std::size_t pairs = 0, open = 0, met = 0, several = 0;
};

/// Compares counters of every `step`-th pixel with the number of triangles that each segment p→l meets, triangle by
/// triangle with exact predicates.
Check check_counters(volumes::DepthCounters& method, const Stage& stage, std::size_t step, CounterTally& tally);

}  // namespace penumbra::selftest
