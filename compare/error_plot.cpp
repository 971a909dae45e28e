// SPDX-License-Identifier: Apache-2.0
// Draws a double-logarithmic plot as SVG, with labels placed without overlaps (greedy).

#include "compare/error_plot.hpp"

#include "compare/report_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

namespace penumbra::compare {
namespace {

/// Mark in drawing coordinates.
struct Dot {
  std::string name;
  std::string_view family;
  double x = 0, y = 0;
};

/// Whole powers of ten around all values except 0.
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

/// Returns the mark in the colour and shape of its family.
std::string mark(const Dot& dot) {
  if (dot.family == "geometry")
    return fmt::format(R"(<circle class="geometry" cx="{:.1f}" cy="{:.1f}" r="5.5"/>)", dot.x, dot.y);
  if (dot.family == "image")
    return fmt::format(R"(<rect class="image" x="{:.1f}" y="{:.1f}" width="10" height="10"/>)", dot.x - 5, dot.y - 5);
  return fmt::format(R"(<path class="reference" d="M{:.1f} {:.1f}l6 6-6 6-6-6z"/>)", dot.x, dot.y - 6);
}

/// Line of text, y at half of its height.
struct Box {
  double x, end, y;
};

/// Returns the names, each to the right of its dot, or to the left if there is no room, and moved up or down if another
/// text is already there. `taken`: other texts.
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
  if (exponent < -4) return fmt::format("1e{}", exponent);  // decimal fractions would be too long for the axis
  return fmt::format("{:.{}f}", std::pow(10, exponent), std::max(0, -exponent));
}

/// Positions of numbers on the drawing.
struct Axes {
  Decades across, along;
  bool has_zero;

  [[nodiscard]] double x_of(double seconds) const { return kLeft + (kRight - kLeft) * across.share(seconds); }
  [[nodiscard]] double y_of(double rmse) const {
    const double bottom = has_zero ? kBottom - kZeroGap : kBottom;
    return rmse < kNoError ? kBottom - 12 : bottom - (bottom - kTop) * along.share(rmse);
  }
};

Axes axes_of(const ErrorPlot& plot) {
  std::vector<double> seconds, errors;
  for (const ErrorPlot::Mark& mark : plot.marks) {
    seconds.push_back(mark.seconds);
    errors.push_back(mark.rmse);
  }
  if (plot.level) errors.push_back(plot.level->rmse);
  return {Decades(seconds), Decades(errors), std::ranges::any_of(errors, [](double e) { return e < kNoError; })};
}

std::string grid(const Axes& axes, const std::string& across) {
  std::string svg;
  for (int decade = axes.across.first; decade <= axes.across.last; ++decade) {
    const double x = axes.x_of(std::pow(10, decade));
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/><text class=\"axis\" text-anchor=\"middle\" x=\"{0:.1f}\" "
        "y=\"{3}\">{4}</text>\n",
        x, kTop, kBottom, kBottom + 18, seconds_text(std::pow(10, decade)));
  }
  for (int decade = axes.along.first; decade <= axes.along.last; ++decade) {
    const double y = axes.y_of(std::pow(10, decade));
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{1} {0:.1f}H{2}\"/><text class=\"axis\" text-anchor=\"end\" x=\"{3}\" "
        "y=\"{4:.1f}\">{5}</text>\n",
        y, kLeft, kRight, kLeft - 8, y + 4, power_of_ten(decade));
  }
  if (axes.has_zero) {
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{0} {2}H{1}\"/><text class=\"axis\" text-anchor=\"end\" x=\"{3}\" "
        "y=\"{4}\">0</text>\n",
        kLeft, kRight, kBottom - 12, kLeft - 8, kBottom - 8);
  }
  svg += fmt::format("<path class=\"frame\" d=\"M{} {}V{}H{}\"/>\n", kLeft, kTop, kBottom, kRight);
  return svg + fmt::format(
                   "<text class=\"axis\" text-anchor=\"middle\" x=\"{}\" y=\"{}\">{}</text>"
                   "<text class=\"axis\" text-anchor=\"middle\" transform=\"translate(14 {}) rotate(-90)\">RMSE of "
                   "V</text>\n",
                   (kLeft + kRight) / 2, kBottom + 40, escape_html(across), (kTop + kBottom) / 2);
}

std::string line(const Axes& axes, const ErrorPlot& plot, const std::vector<std::size_t>& through) {
  std::string path;
  for (const std::size_t i : through)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", axes.x_of(plot.marks[i].seconds),
                        axes.y_of(plot.marks[i].rmse));
  return fmt::format("<path class=\"leader\" fill=\"none\" d=\"{}\"/>\n", path);
}

}  // namespace

std::string error_plot_svg(const ErrorPlot& plot, const std::string& attributes) {
  const Axes axes = axes_of(plot);
  std::string svg = fmt::format("<svg class=\"plot\" viewBox=\"0 0 860 420\" {}>\n", attributes);
  svg += grid(axes, plot.across);
  std::vector<Box> taken;
  if (plot.level && plot.level->rmse >= kNoError) {
    const double y = axes.y_of(plot.level->rmse);
    taken.push_back({kRight + 6, kWidth, y});
    svg += fmt::format(
        "<path class=\"cost\" d=\"M{0} {2:.1f}H{1}\"/><text class=\"axis\" x=\"{3}\" y=\"{4:.1f}\">{5}</text>\n", kLeft,
        kRight, y, kRight + 6, y + 4, escape_html(plot.level->text));
  }
  for (const std::vector<std::size_t>& through : plot.lines) svg += line(axes, plot, through);
  std::vector<Dot> named;
  for (const ErrorPlot::Mark& one : plot.marks) {
    const Dot dot{one.name, one.family, axes.x_of(one.seconds), axes.y_of(one.rmse)};
    svg += fmt::format("<g>{}<title>{}</title></g>\n", mark(dot), escape_html(one.title));
    if (dot.name.empty())
      taken.push_back({dot.x - 7, dot.x + 7, dot.y});
    else
      named.push_back(dot);
  }
  return svg + names(std::move(named), std::move(taken)) + "</svg>";
}

}  // namespace penumbra::compare
