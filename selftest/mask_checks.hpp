#pragma once

#include "selftest/check.hpp"
#include "selftest/small_scenes.hpp"
#include "visibility/method.hpp"
#include "volumes/counters/depth_counters.hpp"

#include <cstddef>
#include <string>

namespace penumbra::selftest {

/// Every bit of a method with masks that claims the truth, against visibility::decide_pair (exact predicates on the
/// stored floats): all passes that make the mask together.
Check check_masks(visibility::Method& method, const Stage& stage, const std::string& name);

/// What a check of counters met: pairs, and of those what has no counter, meets something, meets several triangles.
struct CounterTally {
  std::size_t pairs = 0, open = 0, met = 0, several = 0;
};

/// Counters of every `step`-th pixel against the number of triangles that each segment p→l meets, triangle by triangle
/// with exact predicates.
Check check_counters(volumes::DepthCounters& method, const Stage& stage, std::size_t step, CounterTally& tally);

}  // namespace penumbra::selftest
