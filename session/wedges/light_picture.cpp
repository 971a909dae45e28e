// SPDX-License-Identifier: Apache-2.0
// Draws a light as seen from a view sample, with edges, as SVG (docs/coverage.md).

#include "session/wedges/light_picture.hpp"

#include "volumes/wedges/layer_areas.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace penumbra::session {
namespace {

using volumes::CoveredEdge;
using volumes::LayerSum;
using volumes::LightOutline;

constexpr double kPanel = 440, kMargin = 24, kHead = 64, kFoot = 118;
constexpr double kAround = 0.35;            // margin around the light, relative to its size
constexpr std::uint32_t kMostCells = 32;    // of a texture, on a side
constexpr double kDarkest = 0.3;            // opacity over a black texel
constexpr std::size_t kMostLabels = 24;     // more would hide the labelled edges
constexpr const char* kTakes = "#c0392b";   // edges that take from the light
constexpr const char* kGives = "#2471a3";   // edges that give back
constexpr const char* kHidden = "#bdbdbd";  // hidden by any triangle

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return result;
}

/// Returns the light's boundary as points; a disk's every two degrees.
std::vector<glm::dvec2> boundary_of(const LightOutline& outline) {
  if (!outline.corners.empty()) return outline.corners;
  std::vector<glm::dvec2> rim;
  for (int i = 0; i < 180; ++i) {
    const double angle = 2 * std::numbers::pi * i / 180;
    rim.emplace_back(std::cos(angle), std::sin(angle));
  }
  return rim;
}

/// Returns the point where the ray from an interior point leaves the boundary.
glm::dvec2 leaves_at(const std::vector<glm::dvec2>& boundary, const glm::dvec2& from, const glm::dvec2& direction) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const glm::dvec2 side = boundary[(i + 1) % boundary.size()] - boundary[i];
    const double speed = cross2(side, direction);
    if (speed >= 0) continue;  // not outward
    least = std::min(least, cross2(side, from - boundary[i]) / -speed);
  }
  return from + least * direction;
}

/// Returns the signed angle of the edge's turn around the reference point.
double turn_of(const CoveredEdge& edge, const glm::dvec2& from, const glm::dvec2& to) {
  const double turn = std::atan2(cross2(from, to), glm::dot(from, to));
  if (glm::dot(from, to) > 0) return turn;
  if (edge.side > 0 && turn < 0) return turn + 2 * std::numbers::pi;
  if (edge.side < 0 && turn > 0) return turn - 2 * std::numbers::pi;
  return turn;
}

/// Returns the region beyond the edge: along the edge, and back along the light's boundary.
std::vector<glm::dvec2> region_beyond(const std::vector<glm::dvec2>& boundary, const LayerSum& sum,
                                      const CoveredEdge& edge) {
  const glm::dvec2 c = sum.reference_at, from = edge.clipped.from - c, to = edge.clipped.to - c;
  const double turn = turn_of(edge, from, to);
  std::vector<std::pair<double, glm::dvec2>> between;  // distance back from `to`
  for (const glm::dvec2& corner : boundary) {
    double back = std::atan2(cross2(corner - c, to), glm::dot(corner - c, to));
    if (turn < 0) back = -back;
    if (back < 0) back += 2 * std::numbers::pi;
    if (back < std::abs(turn)) between.emplace_back(back, corner);
  }
  std::ranges::sort(between, {}, &std::pair<double, glm::dvec2>::first);
  std::vector<glm::dvec2> region = {edge.clipped.from, edge.clipped.to, leaves_at(boundary, c, to)};
  for (const auto& [angle, corner] : between) region.push_back(corner);
  region.push_back(leaves_at(boundary, c, from));
  return region;
}

/// Draws one panel after another into a text.
class Drawing {
 public:
  explicit Drawing(const LightPicture& picture) : picture_(picture), boundary_(boundary_of(picture.soft.outline())) {
    const auto [center, u, v] = visibility::light_frame_from(picture.light, picture.sample.p);
    const glm::dvec3 along = u / glm::length(u);
    const bool from_behind = volumes::LightProjection(picture.light, picture.sample.p).turn() < 0;
    axis_u_ = {glm::length(u) * (from_behind ? -1 : 1), 0};
    axis_v_ = {glm::dot(v, along) * (from_behind ? -1 : 1), glm::length(glm::cross(along, v))};
    glm::dvec2 lower = flat(boundary_.front()), upper = lower;
    for (const glm::dvec2& q : boundary_) {
      lower = glm::min(lower, flat(q));
      upper = glm::max(upper, flat(q));
    }
    middle_ = (lower + upper) / 2.0;
    const double size = std::max(upper.x - lower.x, upper.y - lower.y);
    scale_ = kPanel / (size * (1 + 2 * kAround));
    set_shown();
  }

  std::string document() {
    const double width = 2 * kPanel + 3 * kMargin, height = kHead + kPanel + kFoot;
    put("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n",
        width, height);
    put("<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n");
    text(kMargin, 24, picture_.title, 15);
    panel(kMargin, "silhouettes from the light's centre (the method)", volumes::Viewer::center, picture_.center);
    panel(2 * kMargin + kPanel, "silhouettes from the view sample (exact layers)", volumes::Viewer::receiver,
          picture_.receiver);
    legend(kHead + kPanel + 20);
    put("</svg>\n");
    return fmt::to_string(out_);
  }

 private:
  [[nodiscard]] glm::dvec2 flat(const glm::dvec2& q) const { return q.x * axis_u_ + q.y * axis_v_; }
  [[nodiscard]] glm::dvec2 on_page(const glm::dvec2& q) const {
    const glm::dvec2 at = scale_ * (flat(q) - middle_);
    return {left_ + kPanel / 2 + at.x, kHead + kPanel / 2 - at.y};
  }

  template <typename... Args>
  void put(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Args>(args)...);
  }
  void text(double x, double y, const std::string& what, int size = 12, const char* more = "") {
    put("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\"{}>{}</text>\n", x, y, size, more, escaped(what));
  }
  void polygon(const std::vector<glm::dvec2>& points, const std::string& style) {
    put("<polygon points=\"");
    for (const glm::dvec2& q : points) put("{:.2f},{:.2f} ", on_page(q).x, on_page(q).y);
    put("\" {}/>\n", style);
  }
  void line(const volumes::ClippedEdge& edge, const std::string& style) {
    const glm::dvec2 a = on_page(edge.from), b = on_page(edge.to);
    put("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" {}/>\n", a.x, a.y, b.x, b.y, style);
  }

  /// Computes the panel's extent in frame coordinates: the drawn part of edges.
  void set_shown() {
    const double half = kPanel / 2 / scale_, determinant = cross2(axis_u_, axis_v_);
    for (const glm::dvec2& sign :
         std::array{glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)}) {
      const glm::dvec2 at = middle_ + half * sign;
      shown_.corners.emplace_back(cross2(at, axis_v_) / determinant, cross2(axis_u_, at) / determinant);
    }
    if (determinant < 0) std::ranges::reverse(shown_.corners);
  }

  void panel(double left, const std::string& title, volumes::Viewer viewer, const LayerSum& sum) {
    left_ = left;
    text(left, kHead - 14, title);
    put("<clipPath id=\"light{0:.0f}\">", left);
    polygon(boundary_, "");
    put("</clipPath>\n<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#f4f6f7\" "
        "stroke=\"#ccc\"/>\n",
        left, kHead, kPanel, kPanel);
    polygon(boundary_, "fill=\"#fff3b0\"");
    put("<g clip-path=\"url(#light{0:.0f})\" fill=\"{1}\" stroke=\"{1}\" stroke-width=\"0.4\">\n", left, kHidden);
    const auto layers =
        volumes::projected_layers(picture_.light, picture_.sample.p, picture_.soft.layers(picture_.sample));
    for (const auto& layer : layers) polygon(layer, "");
    put("</g>\n");
    texels();
    for (const CoveredEdge& edge : sum.edges) {
      polygon(region_beyond(boundary_, sum, edge),
              fmt::format("fill=\"{}\" fill-opacity=\"0.16\"", edge.area > 0 ? kTakes : kGives));
    }
    polygon(boundary_, "fill=\"none\" stroke=\"#b7950b\" stroke-width=\"1.5\"");
    silhouettes(viewer);
    for (const CoveredEdge& edge : sum.edges) {
      line(edge.clipped, fmt::format("stroke=\"{}\" stroke-width=\"2\"", edge.area > 0 ? kTakes : kGives));
    }
    if (sum.edges.size() <= kMostLabels) labels(sum);
    const glm::dvec2 c = on_page(sum.reference_at);
    put("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"4\" fill=\"black\"/>\n", c.x, c.y);
    text(c.x + 7, c.y - 6, fmt::format("{}{}", sum.moved ? "moved: " : "", sum.constant), 12, " font-weight=\"bold\"");
    text(left, kHead + kPanel + 38,
         fmt::format("{} + ({:.6f}) = {:.6f} layers in the mean; V = {:.6f}", sum.constant, sum.sum, sum.blocked,
                     sum.visibility));
  }

  /// Draws the texture, faintly: the darker a cell, the smaller its weight. Draws blocks of texels if there are too
  /// many to distinguish.
  void texels() {
    if (!picture_.light.texture) return;
    const visibility::LightTexture& texture = *picture_.light.texture;
    const glm::uvec2 cells = glm::min(glm::uvec2(texture.width, texture.height), kMostCells);
    std::vector<double> sums(std::size_t{cells.x} * cells.y), counts(sums.size());
    for (std::size_t i = 0; i < texture.luminance.size(); ++i) {
      const std::size_t x = i % texture.width * cells.x / texture.width;
      const std::size_t y = i / texture.width * cells.y / texture.height;
      sums[y * cells.x + x] += texture.luminance[i];
      ++counts[y * cells.x + x];
    }
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
    const double brightest = *std::ranges::max_element(sums);
    const glm::dvec2 size = 2.0 / glm::dvec2(cells);
    put("<g class=\"texels\" stroke=\"#b7950b\" stroke-width=\"0.2\">\n");
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const std::size_t row = i / cells.x, column = i % cells.x;
      const glm::dvec2 low(-1 + static_cast<double>(column) * size.x, 1 - static_cast<double>(row + 1) * size.y),
          high = low + size;  // rows run from the top
      polygon({low, {high.x, low.y}, high, {low.x, high.y}},
              fmt::format("fill-opacity=\"{:.3f}\"", kDarkest * (1 - sums[i] / brightest)));
    }
    put("</g>\n");
  }

  void silhouettes(volumes::Viewer viewer) {
    const volumes::LightProjection projection(picture_.light, picture_.sample.p);
    put("<g stroke=\"#909090\" stroke-width=\"0.8\">\n");
    for (const auto& [number, multiplicity] : picture_.soft.silhouettes(picture_.sample, viewer)) {
      const auto [a, b] = picture_.casters.graph.edges[number];
      const auto edge = volumes::clip_to_light(shown_, projection(picture_.casters.positions[a]),
                                               projection(picture_.casters.positions[b]));
      if (edge) line(*edge, multiplicity * multiplicity == 1 ? "" : "stroke-dasharray=\"5 2\"");
    }
    put("</g>\n");
  }

  void labels(const LayerSum& sum) {
    for (const CoveredEdge& edge : sum.edges) {
      const glm::dvec2 at = on_page((edge.clipped.from + edge.clipped.to) / 2.0);
      text(at.x + 4, at.y + 12, fmt::format("{:+.4f}", edge.area), 10);
    }
  }

  void legend(double y) {
    const auto entry = [&](double x, double at, const char* color, const std::string& what) {
      put("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"18\" height=\"8\" fill=\"{}\"/>\n", x, at - 8, color);
      text(x + 24, at, what);
    };
    text(kMargin, y, fmt::format("exact V = {:.6f}", picture_.exact), 12, " font-weight=\"bold\"");
    entry(kMargin, y + 44, kTakes, "edge that takes from the light, and the area beyond it");
    entry(kMargin, y + 62, kGives, "edge that gives back, and the area beyond it");
    entry(2 * kMargin + kPanel, y + 44, kHidden, "hidden by some triangle");
    entry(2 * kMargin + kPanel, y + 62, "#909090", "silhouettes as projected; dashed: counted other than once");
    if (picture_.light.texture) {
      text(2 * kMargin + kPanel, y + 80, "cells: the light's texture, darker where it weighs less; areas are weights");
    }
    text(kMargin, y + 80, "dot: the point that areas are seen from, and the number of layers there");
  }

  const LightPicture& picture_;
  std::vector<glm::dvec2> boundary_;
  LightOutline shown_;
  glm::dvec2 axis_u_{1, 0}, axis_v_{0, 1}, middle_{0};
  double scale_ = 1, left_ = 0;
  fmt::memory_buffer out_;
};

}  // namespace

std::string svg_of(const LightPicture& picture) {
  return Drawing(picture).document();
}

}  // namespace penumbra::session
