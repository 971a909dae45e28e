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

namespace penumbra::mesh {

/// The file name's extension in lower case (".obj"); empty if it has none.
std::string lower_extension(const std::filesystem::path& file);

/// Takes the next line off `text`, without its end ("\n", "\r\n" or "\r"). False at the end.
bool take_line(std::string_view& text, std::string_view& line);

/// Takes the next blank-separated word off `line`; empty at its end.
std::string_view take_word(std::string_view& line);

/// The line before its comment, which '#' begins; that of "1.#IND" begins none.
std::string_view without_comment(std::string_view line);

/// A message with words of the file in it, printable: a zero byte among them would end the message there.
template <typename... Args>
std::string text_for_people(fmt::format_string<Args...> format, Args&&... args) {
  return printable(fmt::format(format, std::forward<Args>(args)...));
}

/// The whole of `word` as a number; nothing if it is not one (or an integer is too large for its type). Accepts a
/// leading '+', which from_chars does not. A real that is too large becomes infinite: the caller refuses that by name.
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

/// The same of a real, also one that an old C library wrote for what is no number: "-1.#IND", "1.#QNAN", "1.#INF".
std::optional<double> parse_real(std::string_view word);

}  // namespace penumbra::mesh
