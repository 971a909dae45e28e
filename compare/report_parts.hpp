#pragma once

#include "base/image.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The pieces that the report is put together from. Whatever says "text" is escaped by the function that takes it;
/// whatever says "html" is finished.
namespace penumbra::compare {

/// Safe as an element's content and inside a quoted attribute.
std::string escape_html(std::string_view text);

std::string count_text(std::uint64_t count);               ///< 1 234 567, with narrow no-break spaces
std::string error_text(double error);                      ///< three significant digits: 0, 0.0123, 1.2e-5
std::string signed_text(double error);                     ///< an error with its sign: +0.0123
std::string percent_text(double share);                    ///< 1.23 %
std::string seconds_text(const std::optional<double>& s);  ///< 12.3 ms, 1.23 s, – if not measured
std::string bytes_text(std::uint64_t bytes);               ///< 12.3 MiB
/// "2.1× faster" or "1.4× slower" than the reference, "–" if either was not measured.
std::string speed_text(const std::optional<double>& seconds, const std::optional<double>& reference);
/// The arguments as a shell would want them.
std::string shell_text(std::span<const std::string> arguments);

/// A picture that grows to the window when clicked (a check box and CSS: no script). `caption_html` is finished.
std::string figure_html(const Image8& image, std::string_view alt_text, std::string_view caption_html);

/// The scale of the error pictures, with numbers.
std::string error_legend_html(double limit);
/// The scale of the pictures of V.
std::string visibility_legend_html();
/// A drawing of a light, an object, a floor and the shadow's parts.
std::string shadow_drawing_html();

/// A table of numbers: a caption, a row of headers, rows whose first cell is their header. All cells finished HTML.
struct ReportTable {
  std::string caption;
  std::vector<std::string> headers;
  std::vector<std::vector<std::string>> rows;
};
std::string table_html(const ReportTable& table);

/// The style sheet and the glossary: report_style.cpp.
extern const std::string_view kReportStyle;
extern const std::string_view kReportGlossary;

}  // namespace penumbra::compare
