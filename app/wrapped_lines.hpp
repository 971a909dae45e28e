// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace penumbra::app {

/// Columns of a terminal that a text is put into.
struct TextColumns {
  std::size_t width = 80;  ///< of a whole line
  std::size_t start = 0;   ///< column at which each line of the text begins; the caller has put the first one there
  std::size_t indent = 0;  ///< column at which the rest of a broken line begins
};

/// Breaks each line of a text at blanks, so that it ends within the width. If a line begins with blanks,
/// the lines that continue it begin with the same blanks. A word longer than the width has a line of its own.
std::string wrapped_lines(std::string_view text, const TextColumns& columns);

/// Returns how many columns a UTF-8 text takes, one for each code point: no help text has wide or combining ones.
std::size_t columns_of(std::string_view text);

/// Returns the width in which help is printed: environment variable COLUMNS if it is a whole number, else the
/// terminal's width if stdout is a terminal, else 80. At least 40, so that words fit; at most 100, since longer lines
/// are hard to read.
std::size_t help_width();

}  // namespace penumbra::app
