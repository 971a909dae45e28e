// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// Texts of the report that do not depend on its script, and of pictures as SVG.
namespace penumbra::compare {

/// Returns text safe as an element's content and inside a quoted attribute.
std::string escape_html(std::string_view text);

std::string count_text(std::uint64_t count);               ///< 1 234 567, with narrow no-break spaces
std::string seconds_text(const std::optional<double>& s);  ///< 12.3 ms, 1.23 s, – if not measured
/// Returns the arguments quoted for a shell.
std::string shell_text(std::span<const std::string> arguments);

/// Files of compare/page/: the style sheet, the script, and the page's elements.
extern const std::string_view kReportStyle;
extern const std::string_view kReportScript;
extern const std::string_view kReportMarkup;

}  // namespace penumbra::compare
