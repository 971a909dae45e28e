// SPDX-License-Identifier: Apache-2.0
// Parses `--over KEY=…` of `sweep`: lists, A..B (each value twice the previous one) and A..B+STEP, into at most 63
// values per key.

#include "app/sweep/ranges.hpp"

#include "base/error.hpp"
#include "session/parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace penumbra::app {
namespace {

constexpr std::size_t kMostValues = 64;  // of one key

[[noreturn]] void refuse(std::string_view text) {
  throw UsageError(
      "--over {}: expected KEY=VALUE,VALUE,… or KEY=A..B (doubled) or KEY=A..B+STEP, such as size=256..4096", text);
}

/// Expands "256..4096" or "1..9+2"; returns a text without ".." unchanged.
std::vector<std::string> values_of(std::string_view text, std::string_view whole) {
  const auto dots = text.find("..");
  if (text.empty()) refuse(whole);
  if (dots == std::string_view::npos) return {std::string(text)};
  const std::string_view rest = text.substr(dots + 2);
  const auto plus = rest.find('+');
  const auto first = session::parse_number(text.substr(0, dots)), last = session::parse_number(rest.substr(0, plus));
  const auto step = plus == std::string_view::npos ? std::optional(0.0) : session::parse_number(rest.substr(plus + 1));
  if (!first || !last || !step || *last < *first) refuse(whole);
  if (plus == std::string_view::npos ? *first <= 0 : *step <= 0) refuse(whole);
  std::vector<std::string> values;
  for (std::size_t i = 0; i <= kMostValues; ++i) {
    const auto n = static_cast<double>(i);
    const double value = *step > 0 ? *first + n * *step : *first * static_cast<double>(std::uint64_t{1} << i % 64);
    // A step such as 0.1 is not exactly representable: the last value may be rounded beyond the end.
    if (value > *last + std::abs(*last) * 0x1p-40) return values;
    values.push_back(fmt::format("{:.12g}", value));
    if (i == 63) break;
  }
  throw UsageError("--over {}: more than {} values", whole, kMostValues - 1);
}

}  // namespace

std::vector<SweptKey> parse_over(std::span<const std::string> texts) {
  std::vector<SweptKey> keys;
  for (const std::string& text : texts) {
    bool is_first = true;
    for (const std::string_view part : session::split(text, ',')) {
      const auto equals = part.find('=');
      if (equals != std::string_view::npos) {
        const std::string_view name = part.substr(0, equals);
        if (name.empty()) refuse(text);
        if (std::ranges::find(keys, name, &SweptKey::name) != keys.end())
          throw UsageError("--over {}: {} is given twice", text, name);
        keys.push_back({std::string(name), {}});
      } else if (is_first) {
        refuse(text);
      }
      is_first = false;
      const auto values = values_of(equals == std::string_view::npos ? part : part.substr(equals + 1), text);
      keys.back().values.insert(keys.back().values.end(), values.begin(), values.end());
    }
  }
  return keys;
}

}  // namespace penumbra::app
