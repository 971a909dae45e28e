// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

namespace penumbra::session {

/// Parses the whole text as a number; returns nullopt for any other text.
template <typename Integer>
std::optional<Integer> parse_integer(std::string_view text) {
  Integer value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Parses the whole text as a finite number; returns nullopt for any other text.
inline std::optional<double> parse_number(std::string_view text) {
  const auto value = parse_integer<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Returns the parts between separators; for a text without any, the text.
inline std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

}  // namespace penumbra::session
