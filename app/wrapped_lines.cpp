// SPDX-License-Identifier: Apache-2.0
// Breaks text at words for a terminal of 40 to 100 columns. A column is a code point of UTF-8; wide characters do not
// occur in the program's own texts.

#include "app/wrapped_lines.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include <sys/ioctl.h>
#include <unistd.h>

namespace penumbra::app {
namespace {

constexpr std::size_t kLeastWidth = 40, kMostWidth = 100, kUnknownWidth = 80;

/// Appends one line of the text, broken, without its end.
void append_line(std::string& result, std::string_view line, const TextColumns& columns) {
  const std::size_t blanks = std::min(line.find_first_not_of(' '), line.size());
  const std::string break_and_indent = '\n' + std::string(columns.indent + blanks, ' ');
  result += line.substr(0, blanks);
  line.remove_prefix(blanks);
  std::size_t column = columns.start + blanks;
  bool at_start = true;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find(' '), line.size());
    const std::string_view word = line.substr(0, end);
    if (!at_start && column + 1 + columns_of(word) > columns.width) {
      result += break_and_indent;
      column = columns.indent + blanks;
    } else if (!at_start) {
      result += ' ';
      ++column;
    }
    result += word;
    column += columns_of(word);
    at_start = false;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
}

}  // namespace

std::string wrapped_lines(std::string_view text, const TextColumns& columns) {
  std::string result;
  while (true) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    append_line(result, text.substr(0, end), columns);
    if (end == text.size()) return result;
    text.remove_prefix(end + 1);
    result += '\n';
    if (!text.empty()) result += std::string(columns.start, ' ');
  }
}

std::size_t columns_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::size_t help_width() {
  std::size_t width = 0;
  if (const char* const text = std::getenv("COLUMNS")) {
    const std::string_view digits = text;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), width).ptr != digits.data() + digits.size())
      width = 0;
  }
  if (winsize size{}; width == 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) width = size.ws_col;
  return width == 0 ? kUnknownWidth : std::clamp(width, kLeastWidth, kMostWidth);
}

}  // namespace penumbra::app
