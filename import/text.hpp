// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"
#include "mesh/import_wire.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace penumbra::import {

/// Returns the file name's extension in lower case (".obj"); empty if it has none.
std::string lower_extension(const std::filesystem::path& file);

/// Takes the next line off `text`, without its end ("\n", "\r\n" or "\r"). Returns false at the end.
bool take_line(std::string_view& text, std::string_view& line);

/// Takes the next blank-separated word off `line`; returns an empty word at its end.
std::string_view take_word(std::string_view& line);

/// Returns the line without its comment, which '#' begins, except in "1.#IND".
std::string_view without_comment(std::string_view line);

/// Formats a message that contains words of the file, and makes it printable: a zero byte would end the message.
template <typename... Args>
std::string text_for_people(fmt::format_string<Args...> format, Args&&... args) {
  return mesh::printable(fmt::format(format, std::forward<Args>(args)...));
}

/// Parses the whole of `word` as a number; returns nullopt if it is not one (or an integer is too large for its type).
/// Accepts a leading '+', which from_chars does not. A real that is too large becomes infinite: the caller refuses it.
template <typename Number>
std::optional<Number> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (error == std::errc::result_out_of_range) return std::strtod(std::string(word).c_str(), nullptr);
  }
  if (error != std::errc()) return std::nullopt;
  return value;
}

/// Parses a real as parse_number does, and also "-1.#IND", "1.#QNAN", "1.#INF", which old C libraries wrote for
/// non-numbers.
std::optional<double> parse_real(std::string_view word);

}  // namespace penumbra::import
