// SPDX-License-Identifier: Apache-2.0
// Fields of comma-separated values, quoted as RFC 4180 requires.

#include "base/csv.hpp"

#include <fmt/format.h>

namespace penumbra {

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

std::string csv_field(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "";
}

}  // namespace penumbra
