#pragma once

#include "base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Parts of the report. Parameters named "text" are escaped by the function; parameters named "html" are finished HTML.
namespace penumbra::compare {

/// Returns text safe as an element's content and inside a quoted attribute.
std::string escape_html(std::string_view text);

std::string count_text(std::uint64_t count);               ///< 1 234 567, with narrow no-break spaces
std::string error_text(double error);                      ///< three significant digits: 0, 0.0123, 1.2e-5
std::string signed_text(double error);                     ///< an error with its sign: +0.0123
std::string percent_text(double share);                    ///< 1.23 %
std::string seconds_text(const std::optional<double>& s);  ///< 12.3 ms, 1.23 s, – if not measured
std::string bytes_text(std::uint64_t bytes);               ///< 12.3 MiB
/// Returns "2.1× faster" or "1.4× slower" than the reference, "–" if either was not measured.
std::string speed_text(const std::optional<double>& seconds, const std::optional<double>& reference);
/// Returns the arguments quoted for a shell.
std::string shell_text(std::span<const std::string> arguments);

/// Picture of the viewer opened by a figure.
struct ViewerPlace {
  std::string_view layer;            ///< beauty, v or error
  std::optional<std::size_t> entry;  ///< index in the script's data; empty: not in the viewer
  std::size_t light = 0;
};

/// Writes a picture that grows to the window when clicked (a check box and CSS: no script), or, if the viewer has the
/// picture, one that the page's script paints when it comes into sight, and that opens the viewer. `caption_html` is
/// complete HTML.
std::string figure_html(const Image8& image, std::string_view alt_text, std::string_view caption_html,
                        const ViewerPlace& place = {});

/// Writes a part of the page that opens on request; returns an empty text for an empty part.
std::string folded_html(std::string_view summary_html, std::string_view html);
/// Writes a section that opens on request, with an anchor for links.
std::string folded_section_html(std::string_view id, std::string_view title, std::string_view html);

/// Writes the scale of the error pictures, with numbers.
std::string error_legend_html(double limit);
/// Returns the scale of the pictures of V.
std::string visibility_legend_html();
/// Returns a drawing of a light, an object, a floor and the shadow's parts.
std::string shadow_drawing_html();

/// Cell: finished HTML, and the number by which the column is sorted (empty: by text, a dash last).
struct ReportCell {
  std::string html;
  std::optional<double> value = {};

  ReportCell(std::string text_html, std::optional<double> number = {}) : html(std::move(text_html)), value(number) {}
  ReportCell(const char* text_html) : html(text_html) {}
};

/// Table of numbers: a caption, a row of headers, rows whose first cell is their header.
struct ReportTable {
  std::string caption;
  std::vector<std::string> headers;
  std::vector<std::vector<ReportCell>> rows;
};
std::string table_html(const ReportTable& table);
/// Returns the anchor of a method's description on the page.
std::string method_place(std::string_view method);

/// Glossary: report_words.cpp.
extern const std::string_view kReportGlossary;
/// Files of compare/page/: the style sheet, the script, and the viewer's elements.
extern const std::string_view kReportStyle;
extern const std::string_view kReportScript;
extern const std::string_view kReportMarkup;

}  // namespace penumbra::compare
