// Formats numbers and HTML fragments of the report.

#include "compare/report_parts.hpp"

#include "base/png.hpp"
#include "compare/error_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::compare {
namespace {

constexpr const char* kNotThere = "–";

std::string css_color(const Color8& color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
}

}  // namespace

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

std::string error_text(double error) {
  return fmt::format("{:.3g}", error);
}

std::string signed_text(double error) {
  if (error == 0) return "0";
  // A real minus sign: of the same width as the plus.
  return (error > 0 ? "+" : "−") + error_text(std::abs(error));
}

std::string percent_text(double share) {
  return fmt::format("{:.3g} %", share * 100);
}

std::string seconds_text(const std::optional<double>& s) {
  if (!s) return kNotThere;
  if (*s == 0) return "0";
  if (*s < 1e-3) return fmt::format("{:.3g} µs", *s * 1e6);
  // Below values that would be rounded up to 1000 ms.
  if (*s < 0.9995) return fmt::format("{:.3g} ms", *s * 1e3);
  return *s < 99.95 ? fmt::format("{:.3g} s", *s) : fmt::format("{:.0f} s", *s);
}

std::string bytes_text(std::uint64_t bytes) {
  constexpr std::array kUnits{"bytes", "KiB", "MiB", "GiB", "TiB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1024 && unit + 1 < kUnits.size(); ++unit) value /= 1024;
  return fmt::format("{:.{}f} {}", value, unit == 0 || value >= 100 ? 0 : 1, kUnits[unit]);
}

std::string speed_text(const std::optional<double>& seconds, const std::optional<double>& reference) {
  if (!seconds || !reference || *seconds <= 0 || *reference <= 0) return kNotThere;
  const double ratio = *reference / *seconds;
  const double shown = std::max(ratio, 1 / ratio);
  if (shown < 1.005) return "as fast";
  const std::string factor = shown < 9.995   ? fmt::format("{:.2f}", shown)
                             : shown < 99.95 ? fmt::format("{:.1f}", shown)
                                             : fmt::format("{:.0f}", shown);
  return factor + (ratio > 1 ? "× faster" : "× slower");
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

std::string figure_html(const Image8& image, std::string_view alt_text, std::string_view caption_html,
                        const ViewerPlace& place) {
  const std::string alt = escape_html(alt_text);
  if (place.entry) {
    return fmt::format(
        R"html(<figure><label class="picture"><input type="button" aria-label="Enlarge: {0}" data-layer="{1}" data-entry="{2}" data-light="{3}">
<canvas width="{4}" height="{5}" role="img" aria-label="{0}"></canvas></label><figcaption>{6}</figcaption></figure>
)html",
        alt, place.layer, *place.entry, place.light, image.width, image.height, caption_html);
  }
  return fmt::format(
      R"html(<figure><label class="picture"><input type="checkbox" aria-label="Enlarge: {0}">
<img alt="{0}" width="{1}" height="{2}" src="{3}"></label><figcaption>{4}</figcaption></figure>
)html",
      alt, image.width, image.height, png_data_uri(image), caption_html);
}

std::string folded_html(std::string_view summary_html, std::string_view html) {
  if (html.empty()) return {};
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", summary_html, html);
}

std::string folded_section_html(std::string_view id, std::string_view title, std::string_view html) {
  return fmt::format("<details class=\"part\" id=\"{}\"><summary><h2>{}</h2></summary>\n{}</details>\n", id, title,
                     html);
}

std::string method_place(std::string_view method) {
  return "method-" + escape_html(method);
}

std::string error_legend_html(double limit) {
  // A tick's position is √ of its fraction of the limit: the same curve as error_color's. Quarters of the limit are at
  // half of the axis, sixteenths at a quarter.
  std::string stops, ticks;
  constexpr int kStops = 32;
  for (int i = -kStops; i <= kStops; ++i) {
    const double place = static_cast<double>(i) / kStops;
    const std::string color = css_color(error_color(std::copysign(place * place * limit, place), limit));
    stops += fmt::format("{}{}", stops.empty() ? "" : ", ", color);
  }
  for (const double share : {-1.0, -0.25, -0.0625, 0.0, 0.0625, 0.25, 1.0}) {
    const double place = 50 + 50 * std::copysign(std::sqrt(std::abs(share)), share);
    ticks += fmt::format(R"html(<span style="left:{:.1f}%">{}</span>)html", place, signed_text(share * limit));
  }
  return fmt::format(
      R"html(<div class="legend" role="img"
aria-label="Scale of the error of V: red is too dark down to −{0}, white is right, blue is too bright up to +{0}">
<div class="ends"><span>◀ too dark</span><span>right</span><span>too bright ▶</span></div>
<div class="bar" style="background:linear-gradient(to right, {1})"></div><div class="ticks">{2}</div>
</div>
<p class="note">V of the method less V of the reference. The colour deepens with the square root of the error, so that
small errors show; what is further off than ±{0} has the deepest colour.
<span class="swatch" style="background:{3}"></span> is background.</p>
)html",
      error_text(limit), stops, ticks, css_color(kBackgroundColor));
}

std::string visibility_legend_html() {
  std::string ticks;
  for (const auto& [place, text] :
       std::array<std::pair<int, const char*>, 5>{{{0, "0"}, {25, "0.25"}, {50, "0.5"}, {75, "0.75"}, {100, "1"}}}) {
    ticks += fmt::format(R"html(<span style="left:{}%">{}</span>)html", place, text);
  }
  return fmt::format(
      R"html(<div class="legend" role="img"
aria-label="Grey scale of V: black is 0, the light is hidden; white is 1, the whole light is seen">
<div class="ends"><span>light hidden</span><span>light seen</span></div>
<div class="bar" style="background:linear-gradient(to right, #000, #fff)"></div><div class="ticks">{}</div>
</div>
<p class="note"><span class="swatch" style="background:{}"></span> is background.</p>
)html",
      ticks, css_color(kBackgroundColor));
}

std::string table_html(const ReportTable& table) {
  std::string html = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\"><table class=\"sortable\"><caption>{}</caption><thead><tr>", table.caption);
  for (const std::string& header : table.headers) html += fmt::format(R"html(<th scope="col">{}</th>)html", header);
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string value = row[i].value ? fmt::format(" data-value=\"{}\"", *row[i].value) : "";
      html += i == 0 ? fmt::format("<th scope=\"row\">{}</th>", row[i].html)
                     : fmt::format("<td{}>{}</td>", value, row[i].html);
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string shadow_drawing_html() {
  // Light from x = 150 to 250 at y = 20, object from 165 to 235 at y = 90, floor at y = 170. Straight lines past the
  // object's ends meet the floor at: from the light's near end 165 + (165 − 150) · 80 / 70 = 182.1, from its far end
  // 165 − (250 − 165) · 80 / 70 = 67.9, and mirrored at 200: 217.9 and 332.1.
  return R"html(<svg class="drawing" viewBox="0 0 400 215" role="img" aria-label="Drawing: an area light above an object
above a floor. Under the object lies the umbra, which sees no light; beside it, on both sides, the penumbra,
which sees part of it; outside, the floor sees all of it.">
<defs><linearGradient id="fade-left"><stop offset="0" stop-color="#f3d27a"/><stop offset="1" stop-color="#20222a"/>
</linearGradient><linearGradient id="fade-right"><stop offset="0" stop-color="#20222a"/>
<stop offset="1" stop-color="#f3d27a"/></linearGradient></defs>
<polygon class="cone" points="150,20 250,20 332.1,170 67.9,170"/>
<path class="ray" d="M150 20 182.1 170M250 20 67.9 170M250 20 217.9 170M150 20 332.1 170"/>
<polygon class="shade" points="165,90 235,90 217.9,170 182.1,170"/>
<rect x="10" y="170" width="57.9" height="12" fill="#f3d27a"/>
<rect x="67.9" y="170" width="114.2" height="12" fill="url(#fade-left)"/>
<rect x="182.1" y="170" width="35.8" height="12" fill="#20222a"/>
<rect x="217.9" y="170" width="114.2" height="12" fill="url(#fade-right)"/>
<rect x="332.1" y="170" width="57.9" height="12" fill="#f3d27a"/>
<rect x="150" y="15" width="100" height="6" rx="2" fill="#f0a500"/>
<rect class="object" x="165" y="86" width="70" height="10" rx="2"/>
<g text-anchor="middle"><text x="38" y="198">lit: V = 1</text><text x="125" y="198">penumbra</text>
<text x="200" y="198">umbra</text><text x="275" y="198">penumbra</text><text x="362" y="198">lit: V = 1</text>
<text class="small" x="125" y="211">0 &lt; V &lt; 1</text><text class="small" x="200" y="211">V = 0</text>
<text class="small" x="275" y="211">0 &lt; V &lt; 1</text></g>
<text x="260" y="23">area light</text><text x="245" y="95">object</text>
</svg>
)html";
}

}  // namespace penumbra::compare
