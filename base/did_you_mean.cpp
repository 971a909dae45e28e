#include "base/did_you_mean.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace penumbra {
namespace {

/// Levenshtein's distance: how many letters must be changed, added or left out to make one of the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string did_you_mean(std::string_view text, const std::vector<std::string>& names) {
  const auto distance = [&](const std::string& name) { return edit_distance(text, name); };
  const auto nearest = std::ranges::min_element(names, {}, distance);
  if (nearest == names.end() || 3 * distance(*nearest) > nearest->size()) return {};
  return fmt::format("; did you mean {}?", *nearest);
}

}  // namespace penumbra
