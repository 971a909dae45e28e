// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/stats.hpp"
#include "visibility/method.hpp"

#include <string>

namespace penumbra::compare {

/// Method as it was run. Both members must outlive this object.
struct Asked {
  const visibility::MethodDescription& description;
  const Stats& stats;
};

/// Returns the quantity computed by the method, in words: visibility of N light samples, the exact visible area of the
/// light, or its estimate.
std::string question_of(const Asked& asked);

/// Returns whether two entries compute the same quantity, so that the ratio of their seconds is meaningful: of two
/// methods with masks, the one with a quarter of the light samples is not faster for needing a quarter of the time. Two
/// estimates of V never compute the same quantity. `chosen_pixels`: methods that work pixel by pixel evaluated only
/// some pixels, others all of them.
bool same_question(const Asked& a, const Asked& b, bool chosen_pixels);

}  // namespace penumbra::compare
