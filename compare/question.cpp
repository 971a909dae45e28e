// SPDX-License-Identifier: Apache-2.0
// Decides which entries of a comparison compute the same quantity.

#include "compare/question.hpp"

#include <fmt/format.h>

namespace penumbra::compare {

std::string question_of(const Asked& asked) {
  switch (asked.description.output) {
    case visibility::Output::mask:
      return fmt::format("{} light samples", asked.stats.light_samples);
    case visibility::Output::radiance:
      return "areas, no light samples";
    case visibility::Output::scalar:
      break;
  }
  return "an estimate of V, no light samples";
}

bool same_question(const Asked& a, const Asked& b, bool chosen_pixels) {
  if (a.description.output != b.description.output) return false;
  switch (a.description.output) {
    case visibility::Output::mask:
      return a.stats.light_samples == b.stats.light_samples && a.stats.sample_pattern == b.stats.sample_pattern;
    case visibility::Output::radiance:
      return !chosen_pixels || a.stats.method == b.stats.method;
    case visibility::Output::scalar:
      break;
  }
  return false;
}

}  // namespace penumbra::compare
