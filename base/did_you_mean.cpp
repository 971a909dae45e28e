// SPDX-License-Identifier: Apache-2.0
// Suggestions for misspelled names: edit distance, and abbreviations that are the last words of a name.

#include "base/did_you_mean.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace penumbra {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Returns the Levenshtein distance with Damerau's transposition, ignoring case: the number of letters to change,
/// insert, delete or exchange with the next.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1), before(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    next[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const auto same = [&](std::size_t k, std::size_t l) { return lower(a[k]) == lower(b[l]); };
      next[j + 1] = std::min({row[j] + (same(i, j) ? 0 : 1), next[j] + 1, row[j + 1] + 1});
      if (i > 0 && j > 0 && same(i, j - 1) && same(i - 1, j)) next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
    }
    std::swap(before, row);
    std::swap(row, next);
  }
  return row.back();
}

/// Returns whether `text` is the last words of `name`: "samples" or "--samples" of "--light-samples".
bool ends_with_words(std::string_view name, std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of('-'), text.size()));
  return text.size() > 3 && name.size() > text.size() && name.ends_with(text) &&
         name[name.size() - text.size() - 1] == '-';
}

}  // namespace

std::string did_you_mean(std::string_view text, const std::vector<std::string>& names) {
  const auto distance = [&](const std::string& name) { return edit_distance(text, name); };
  const auto nearest = std::ranges::min_element(names, {}, distance);
  const auto longer = std::ranges::find_if(names, [&](const auto& name) { return ends_with_words(name, text); });
  if (longer != names.end() && distance(*nearest) > 1) return fmt::format("; did you mean {}?", *longer);
  if (nearest == names.end() || 3 * distance(*nearest) > nearest->size()) return {};
  return fmt::format("; did you mean {}?", *nearest);
}

}  // namespace penumbra
