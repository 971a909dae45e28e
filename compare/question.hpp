#pragma once

#include "compare/stats.hpp"
#include "visibility/method.hpp"

#include <string>

namespace penumbra::compare {

/// A method as it was run. Both must outlive it.
struct Asked {
  const visibility::MethodDescription& description;
  const Stats& stats;
};

/// What it was asked, in words: which of how many light samples are visible, how much of the light's area, or about how
/// much of it.
std::string question_of(const Asked& asked);

/// Do two entries answer one question? Only then do their seconds give a ratio: of two methods with masks, the one that
/// is asked for a quarter of the light samples is no faster for needing a quarter of the time. Two estimates of V are
/// never the same question. `chosen_pixels`: a method that works pixel by pixel did only some, others all of them.
bool same_question(const Asked& a, const Asked& b, bool chosen_pixels);

}  // namespace penumbra::compare
