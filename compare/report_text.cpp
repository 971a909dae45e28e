// SPDX-License-Identifier: Apache-2.0
// Formats texts of the report.

#include "compare/report_text.hpp"

#include <fmt/format.h>

namespace penumbra::compare {

std::string escape_html(std::string_view text) {
  std::string html;
  html.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string count_text(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += "\u202f";
    text += digits[i];
  }
  return text;
}

std::string seconds_text(const std::optional<double>& s) {
  if (!s) return "–";
  if (*s == 0) return "0";
  if (*s < 1e-3) return fmt::format("{:.3g} µs", *s * 1e6);
  // Below values that would be rounded up to 1000 ms.
  if (*s < 0.9995) return fmt::format("{:.3g} ms", *s * 1e3);
  return *s < 99.95 ? fmt::format("{:.3g} s", *s) : fmt::format("{:.0f} s", *s);
}

std::string shell_text(std::span<const std::string> arguments) {
  constexpr std::string_view kHarmless = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%^";
  std::string text;
  for (const std::string& argument : arguments) {
    if (!text.empty()) text += ' ';
    if (!argument.empty() && argument.find_first_not_of(kHarmless) == std::string::npos) {
      text += argument;
      continue;
    }
    text += '\'';
    for (const char c : argument) {
      if (c == '\'')
        text += R"('\'')";
      else
        text += c;
    }
    text += '\'';
  }
  return text;
}

}  // namespace penumbra::compare
