// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace penumbra {

/// Returns the length of the well-formed UTF-8 sequence that `text` (not empty) starts with; 0 if it is ill-formed.
std::size_t utf8_length(std::string_view text);

/// Returns the text with bytes that are not UTF-8 as "\xff", for names of files in JSON and CSV (the error handler
/// backslashreplace of Python).
std::string as_utf8(std::string_view text);

/// Returns the text on one line, for names of files in tables: as_utf8, with control characters as "\n", "\t", "\x1b".
std::string on_one_line(std::string_view text);

}  // namespace penumbra
