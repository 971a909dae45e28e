#include "compare/report_plots.hpp"

#include "compare/report_parts.hpp"
#include "compare/report_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra::compare {
namespace {

struct Dot {
  std::string name;
  const char* family;
  double seconds = 0, rmse = 0;
  double x = 0, y = 0;  ///< on the drawing
};

/// V is a float: an error of less than half of its last digit, and the mean of such errors, is drawn as none.
constexpr double kNoError = 0x1p-25;

/// Whole powers of ten around all values that are not none.
struct Decades {
  int first = 0, last = 1;
  explicit Decades(std::span<const double> values) {
    double smallest = 0, largest = 0;
    for (const double value : values) {
      if (value < kNoError) continue;
      smallest = smallest == 0 ? value : std::min(smallest, value);
      largest = std::max(largest, value);
    }
    if (smallest == 0) return;
    first = static_cast<int>(std::floor(std::log10(smallest)));
    last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(largest))));
  }
  [[nodiscard]] double share(double value) const { return (std::log10(value) - first) / (last - first); }
};

constexpr double kLeft = 64, kRight = 660, kTop = 16, kBottom = 372, kZeroGap = 34, kWidth = 860;

/// By family in colour and in shape.
std::string mark(const Dot& dot) {
  const std::string_view family = dot.family;
  if (family == "geometry")
    return fmt::format(R"(<circle class="geometry" cx="{:.1f}" cy="{:.1f}" r="5.5"/>)", dot.x, dot.y);
  if (family == "image")
    return fmt::format(R"(<rect class="image" x="{:.1f}" y="{:.1f}" width="10" height="10"/>)", dot.x - 5, dot.y - 5);
  return fmt::format(R"(<path class="reference" d="M{:.1f} {:.1f}l6 6-6 6-6-6z"/>)", dot.x, dot.y - 6);
}

/// A line of text, y at half of its height.
struct Box {
  double x, end, y;
};

/// Each name to the right of its dot, or to the left where it would not fit, and further up or down where something
/// else is already; `taken`: other texts.
std::string names(std::vector<Dot> dots, std::vector<Box> taken) {
  constexpr double kLine = 15;
  std::ranges::sort(dots, [](const Dot& a, const Dot& b) { return std::pair(a.y, a.x) < std::pair(b.y, b.x); });
  for (const Dot& dot : dots) taken.push_back({dot.x - 7, dot.x + 7, dot.y});
  std::string svg;
  for (const Dot& dot : dots) {
    const double width = 7.0 * static_cast<double>(dot.name.size());
    const bool is_left = dot.x + 10 + width > kWidth;
    Box box = is_left ? Box{dot.x - 10 - width, dot.x - 10, dot.y} : Box{dot.x + 10, dot.x + 10 + width, dot.y};
    for (double shift = 0; shift < 20 * kLine; shift += kLine / 3) {
      bool is_free = false;
      for (const double y : {dot.y - shift, dot.y + shift}) {
        box.y = y;
        is_free = y > kTop + 4 && y < kBottom + 4 && std::ranges::none_of(taken, [&](const Box& other) {
                    return box.x < other.end && other.x < box.end && std::abs(box.y - other.y) < kLine - 1;
                  });
        if (is_free) break;
      }
      if (is_free) break;
    }
    taken.push_back(box);
    if (std::abs(box.y - dot.y) > 6)
      svg += fmt::format("<path class=\"leader\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>", dot.x, dot.y,
                         is_left ? box.end + 1 : box.x - 1, box.y);
    svg += fmt::format("<text{} x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", is_left ? " text-anchor=\"end\"" : "",
                       is_left ? box.end : box.x, box.y + 4, escape_html(dot.name));
  }
  return svg;
}

std::string power_of_ten(int exponent) {
  if (exponent < -4) return fmt::format("1e{}", exponent);  // longer ones would not fit beside the axis
  return fmt::format("{:.{}f}", std::pow(10, exponent), std::max(0, -exponent));
}

}  // namespace

std::string error_against_time_html(const ReportInput& in) {
  std::vector<Dot> dots;
  std::vector<double> seconds, errors;
  for (std::size_t i = 0; i < in.methods.size(); ++i) {
    const MethodResult& result = in.metrics.methods[i];
    const auto rmse = rmse_of(result), shadow = shadow_of(result);
    if (!rmse || !shadow || *shadow <= 0) continue;
    dots.push_back({result.entry, visibility::name_of(in.methods[i].description.family), *shadow, *rmse});
    seconds.push_back(*shadow);
    errors.push_back(*rmse);
  }
  if (dots.empty()) return {};
  std::optional<double> cost;
  if (in.metrics.same_samples && in.metrics.same_samples->all_lights_error) {
    cost = in.metrics.same_samples->all_lights_error->rmse;
    errors.push_back(*cost);
  }
  const Decades across(seconds), along(errors);
  const bool has_zero = std::ranges::any_of(errors, [](double error) { return error < kNoError; });
  const double bottom = has_zero ? kBottom - kZeroGap : kBottom;
  const auto x_of = [&](double value) { return kLeft + (kRight - kLeft) * across.share(value); };
  const auto y_of = [&](double value) {
    return value < kNoError ? kBottom - 12 : bottom - (bottom - kTop) * along.share(value);
  };
  std::string svg =
      "<div class=\"wide\"><svg class=\"plot\" viewBox=\"0 0 860 420\" role=\"img\" aria-label=\"Error of V against "
      "time, one mark a "
      "method; the tables below have the numbers\">\n";
  for (int decade = across.first; decade <= across.last; ++decade) {
    const double x = x_of(std::pow(10, decade));
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/><text class=\"axis\" text-anchor=\"middle\" x=\"{0:.1f}\" "
        "y=\"{3}\">{4}</text>\n",
        x, kTop, kBottom, kBottom + 18, seconds_text(std::pow(10, decade)));
  }
  for (int decade = along.first; decade <= along.last; ++decade) {
    const double y = y_of(std::pow(10, decade));
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{1} {0:.1f}H{2}\"/><text class=\"axis\" text-anchor=\"end\" x=\"{3}\" "
        "y=\"{4:.1f}\">{5}</text>\n",
        y, kLeft, kRight, kLeft - 8, y + 4, power_of_ten(decade));
  }
  if (has_zero) {
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{0} {2}H{1}\"/><text class=\"axis\" text-anchor=\"end\" x=\"{3}\" "
        "y=\"{4}\">0</text>\n",
        kLeft, kRight, kBottom - 12, kLeft - 8, kBottom - 8);
  }
  svg += fmt::format("<path class=\"frame\" d=\"M{} {}V{}H{}\"/>\n", kLeft, kTop, kBottom, kRight);
  svg += fmt::format(
      "<text class=\"axis\" text-anchor=\"middle\" x=\"{}\" y=\"{}\">seconds for the shadow{}</text>"
      "<text class=\"axis\" text-anchor=\"middle\" transform=\"translate(14 {}) rotate(-90)\">RMSE of V</text>\n",
      (kLeft + kRight) / 2, kBottom + 40, in.lights.size() > 1 ? " of all lights" : "", (kTop + kBottom) / 2);
  std::vector<Box> taken;
  if (cost && *cost >= kNoError) {
    taken.push_back({kRight + 6, kWidth, y_of(*cost)});
    svg += fmt::format(
        "<path class=\"cost\" d=\"M{0} {2:.1f}H{1}\"/><text class=\"axis\" x=\"{3}\" y=\"{4:.1f}\">what {5} light "
        "samples cost</text>\n",
        kLeft, kRight, y_of(*cost), kRight + 6, y_of(*cost) + 4, in.metrics.same_samples->stats.light_samples);
  }
  for (Dot& dot : dots) {
    dot.x = x_of(dot.seconds);
    dot.y = y_of(dot.rmse);
    svg += fmt::format("<g>{}<title>{}: RMSE {}, {}</title></g>\n", mark(dot), escape_html(dot.name),
                       error_text(dot.rmse), seconds_text(dot.seconds));
  }
  svg += names(dots, taken) + "</svg></div>\n";
  std::string html = "<h3>Error against time</h3>\n" + svg +
                     "<p class=\"note\">Further down is closer to the reference, further left is faster; both scales "
                     "step by tens. Circles are geometry-based methods, squares image-based ones, diamonds references.";
  if (cost && *cost >= kNoError) {
    html += fmt::format(
        " The dashed line is how far rays on the methods’ own {} light samples are from the reference: a method with a "
        "mask can be as exact as can be and yet come no lower, and it is no fault of its own.",
        in.metrics.same_samples->stats.light_samples);
  }
  return html + "</p>\n";
}

}  // namespace penumbra::compare
