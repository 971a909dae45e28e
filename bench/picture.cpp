// Draws errors against seconds as SVG.

#include "bench/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace penumbra::bench {
namespace {

constexpr double kWidth = 420, kHeight = 340;                       // of a panel, in pixels
constexpr double kLeft = 62, kRight = 14, kTop = 30, kBottom = 46;  // a panel's margins around its plot
constexpr std::size_t kAcross = 3;                                  // panels side by side
constexpr double kLegendLine = 18, kTitle = 58;                     // heights
constexpr std::array kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                 "#e69f00", "#56b4e9", "#000000", "#7f7f7f"};  // Okabe and Ito's colours, and grey

struct Point {
  double seconds = 0, rmse = 0;
  std::uint64_t samples = 0;
};

struct Curve {
  std::size_t contestant = 0;  ///< index into Picture::contestants
  std::vector<Point> points;   ///< in order of light samples
};

struct Panel {
  std::string subject;
  std::vector<Curve> curves;
};

/// Axis over whole decades.
struct Axis {
  int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();

  void include(double value) {
    const double decade = std::log10(value);
    low = std::min(low, static_cast<int>(std::floor(decade)));
    high = std::max(high, static_cast<int>(std::floor(decade)) + 1);
  }
  [[nodiscard]] double place(double value) const { return (std::log10(value) - low) / (high - low); }
};

struct Picture {
  std::vector<std::string> contestants;
  std::vector<Panel> panels;
  Axis seconds, rmse;
  std::size_t left_out = 0;
  std::string reference;
};

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else {
      result += c;
    }
  }
  return result;
}

std::size_t place_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

Panel& panel_of(Picture& picture, const std::string& subject) {
  const auto found = std::ranges::find(picture.panels, subject, &Panel::subject);
  if (found != picture.panels.end()) return *found;
  picture.panels.push_back({subject, {}});
  return picture.panels.back();
}

Curve& curve_of(Panel& panel, std::size_t contestant) {
  const auto found = std::ranges::find(panel.curves, contestant, &Curve::contestant);
  if (found != panel.curves.end()) return *found;
  panel.curves.push_back({contestant, {}});
  return panel.curves.back();
}

Picture gather(const std::vector<Entry>& entries) {
  Picture picture;
  for (const Entry& entry : entries) {
    Panel& panel = panel_of(picture, entry.subject);
    if (!entry.reference.empty()) picture.reference = entry.reference;
    for (const Contestant& contestant : entry.contestants) {
      if (!contestant.error_to_reference) continue;  // no judged pixel
      const Point point{timing_of(contestant.times.shadow()).median, contestant.error_to_reference->rmse,
                        entry.samples};
      Curve& curve = curve_of(panel, place_of(picture.contestants, contestant.name));
      if (point.rmse > 0 && point.seconds > 0) {
        picture.seconds.include(point.seconds);
        picture.rmse.include(point.rmse);
        curve.points.push_back(point);
      } else {
        ++picture.left_out;
      }
    }
    for (Curve& curve : panel.curves) std::ranges::sort(curve.points, {}, &Point::samples);
  }
  if (picture.seconds.low > picture.seconds.high) {  // there is nothing to show
    picture.seconds.include(1);
    picture.rmse.include(1);
  }
  return picture;
}

std::string style_of(std::size_t contestant) {
  return fmt::format("stroke=\"{}\"{}", kColours[contestant % kColours.size()],
                     contestant < kColours.size() ? "" : " stroke-dasharray=\"5 3\"");
}

std::string text(double x, double y, const std::string& words, std::string_view more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", x, y, more, escaped(words));
}

/// Transformation from values to positions in a panel.
struct Frame {
  const Picture& picture;

  [[nodiscard]] double x(double seconds) const {
    return kLeft + picture.seconds.place(seconds) * (kWidth - kLeft - kRight);
  }
  [[nodiscard]] double y(double rmse) const {
    return kHeight - kBottom - picture.rmse.place(rmse) * (kHeight - kTop - kBottom);
  }
};

std::string draw_axes(const Frame& frame) {
  const Picture& picture = frame.picture;
  const double bottom = kHeight - kBottom, right = kWidth - kRight;
  std::string svg;
  for (int decade = picture.seconds.low; decade <= picture.seconds.high; ++decade) {
    const double x = frame.x(std::pow(10.0, decade));
    svg += fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1:.1f}V{2:.1f}\"/>\n", x, kTop, bottom);
    svg += text(x, bottom + 16, fmt::format("{:g}", std::pow(10.0, decade)), " text-anchor=\"middle\"");
  }
  for (int decade = picture.rmse.low; decade <= picture.rmse.high; ++decade) {
    const double y = frame.y(std::pow(10.0, decade));
    svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", kLeft, y, right);
    svg += text(kLeft - 6, y + 4, fmt::format("{:g}", std::pow(10.0, decade)), " text-anchor=\"end\"");
  }
  svg += text((kLeft + right) / 2, bottom + 36, "shadow, seconds", " text-anchor=\"middle\"");
  svg += fmt::format("<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">RMSE of V</text>\n",
                     (kTop + bottom) / 2);
  return svg;
}

std::string draw_curve(const Frame& frame, const Curve& curve, const std::string& name) {
  std::string line, marks;
  for (const Point& point : curve.points) {
    const double x = frame.x(point.seconds), y = frame.y(point.rmse);
    line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x, y);
    marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"><title>{}</title></circle>\n", x, y,
                         kColours[curve.contestant % kColours.size()],
                         escaped(fmt::format("{}, {} light samples: {:.4g} s, RMSE {:.3g}", name, point.samples,
                                             point.seconds, point.rmse)));
    if (curve.contestant == 0 || name == "plain-rays")  // labels of all contestants would overlap
      marks += text(x + 5, y - 4, std::to_string(point.samples), " class=\"small\"");
  }
  if (line.empty()) return "";
  return fmt::format("<path fill=\"none\" stroke-width=\"1.8\" {} d=\"{}\"/>\n", style_of(curve.contestant), line) +
         marks;
}

std::string draw_panel(const Picture& picture, const Panel& panel) {
  const Frame frame{picture};
  std::string svg = text(kLeft, kTop - 10, panel.subject, " font-weight=\"bold\"") + draw_axes(frame);
  for (const Curve& curve : panel.curves) svg += draw_curve(frame, curve, picture.contestants[curve.contestant]);
  return svg;
}

std::string draw_legend(const Picture& picture) {
  std::string svg;
  for (std::size_t i = 0; i < picture.contestants.size(); ++i) {
    const double y = kTitle + static_cast<double>(i) * kLegendLine;
    svg += fmt::format("<path stroke-width=\"2.5\" {} d=\"M{} {:.1f}h28\"/>\n", style_of(i), kLeft, y);
    svg += text(kLeft + 36, y + 4, picture.contestants[i]);
  }
  return svg;
}

}  // namespace

std::string svg_picture(const std::vector<Entry>& entries) {
  const Picture picture = gather(entries);
  const std::size_t columns = std::clamp<std::size_t>(picture.panels.size(), 1, kAcross);
  const std::size_t rows = (picture.panels.size() + columns - 1) / columns;
  const double head = kTitle + static_cast<double>(picture.contestants.size()) * kLegendLine;
  const double width = std::max(2.0, static_cast<double>(columns)) * kWidth;
  const double height = head + static_cast<double>(rows) * kHeight;
  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} {1:g}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n"
      "<style>.grid{{stroke:#ddd;stroke-width:1}} .small{{font-size:9px;fill:#555}}</style>\n"
      "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#fff\"/>\n",
      width, height);
  svg += text(kLeft, 22, "Error against time: RMSE of V to " + picture.reference + ", numbers: light samples",
              " font-size=\"14\"");
  if (picture.left_out > 0) svg += text(kLeft, 40, fmt::format("{} points not shown: error 0", picture.left_out));
  svg += draw_legend(picture);
  for (std::size_t i = 0; i < picture.panels.size(); ++i) {
    const std::size_t row = i / columns, column = i % columns;
    svg += fmt::format("<g transform=\"translate({:g} {:g})\">\n", static_cast<double>(column) * kWidth,
                       head + static_cast<double>(row) * kHeight);
    svg += draw_panel(picture, picture.panels[i]) + "</g>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace penumbra::bench
