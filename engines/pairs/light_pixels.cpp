// SPDX-License-Identifier: Apache-2.0
// View samples in lists of light pixels (irregular z-buffer): Johnson et al. 2005, section 3; Sintorn, Eisemann and
// Assarsson 2008, section 4.

#include "engines/pairs/light_pixels.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::pairs {
namespace {

double cross(const glm::dvec2& o, const glm::dvec2& a, const glm::dvec2& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// Returns the pixels of [from, to] among `count`.
PixelRange range_of(double from, double to, std::uint32_t count) {
  if (!(to >= 0) || !(from < count)) return {};
  const double last = count - 1.0;
  return {static_cast<std::uint32_t>(std::clamp(std::floor(from), 0.0, last)),
          static_cast<std::uint32_t>(std::clamp(std::floor(to), 0.0, last))};
}

}  // namespace

LightPixels::LightPixels(std::span<const glm::dvec2> places, double error, double per_pixel) {
  if (places.empty()) return;
  lower_ = upper_ = places.front();
  for (const glm::dvec2& place : places) {
    lower_ = glm::min(lower_, place);
    upper_ = glm::max(upper_, place);
  }
  // Square pixels, also in a long and narrow window.
  const glm::dvec2 size = glm::max(upper_ - lower_, glm::dvec2(std::numeric_limits<double>::min()));
  const double pixels = std::max(1.0, static_cast<double>(places.size()) / per_pixel);
  const double across = std::sqrt(pixels) * std::sqrt(size.x / size.y);
  columns_ = static_cast<std::uint32_t>(std::clamp(across, 1.0, std::min(pixels, 8192.0)));
  rows_ = static_cast<std::uint32_t>(std::clamp(pixels / columns_, 1.0, 8192.0));
  scale_ = glm::dvec2(columns_, rows_) / size;
  // A place minus the window's corner, times the scale: two roundings of at most the largest coordinate.
  const double largest = std::max({std::abs(lower_.x), std::abs(lower_.y), std::abs(upper_.x), std::abs(upper_.y)});
  error_ = (error + 0x1p-51 * largest) * std::max(scale_.x, scale_.y) + 0x1p-30;

  begin_.assign(std::size_t{rows_} * columns_ + 1, 0);
  for (const glm::dvec2& place : places) ++begin_[pixel_of(place) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) {
    longest_ = std::max<std::size_t>(longest_, begin_[i]);
    begin_[i] += begin_[i - 1];
  }
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  numbers_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) numbers_[next[pixel_of(places[i])]++] = static_cast<std::uint32_t>(i);
}

std::uint32_t LightPixels::pixel_of(const glm::dvec2& place) const {
  const glm::dvec2 at = (place - lower_) * scale_;
  const auto column = static_cast<std::uint32_t>(std::clamp(std::floor(at.x), 0.0, columns_ - 1.0)),
             row = static_cast<std::uint32_t>(std::clamp(std::floor(at.y), 0.0, rows_ - 1.0));
  return row * columns_ + column;
}

/// Andrew's monotone chain. It may drop a corner that rounding puts inside: a cross product of differences u and v, u.x
/// between 0 and v.x, is off by 2⁻⁵¹ |v.x| (|u.y| + |v.y|), so each dropped corner is outside by at most 2⁻⁵⁰ of the
/// points' extent, once for each point. The margin includes this error.
PixelHull LightPixels::hull_of(const Footprint& footprint) const {
  PixelHull hull;
  std::array<glm::dvec2, Footprint::kMost> points;
  double largest = 0;
  for (std::size_t i = 0; i < footprint.count; ++i) {
    points[i] = (footprint.points[i] - lower_) * scale_;
    largest = std::max({largest, std::abs(points[i].x), std::abs(points[i].y)});
  }
  hull.margin = footprint.error * std::max(scale_.x, scale_.y) + error_ + 0x1p-44 * largest;
  hull.everywhere = footprint.everywhere || !(hull.margin < 1e15);
  if (hull.everywhere || footprint.count == 0) return hull;
  const auto end = points.begin() + static_cast<std::ptrdiff_t>(footprint.count);
  std::sort(points.begin(), end,
            [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  const auto add = [&](const glm::dvec2& point, std::size_t least) {
    while (hull.count >= least + 2 && cross(hull.corners[hull.count - 2], hull.corners[hull.count - 1], point) <= 0)
      --hull.count;
    hull.corners[hull.count++] = point;
  };
  for (auto it = points.begin(); it != end; ++it) add(*it, 0);
  const std::size_t right = hull.count - 1;
  for (auto it = end - 1; it != points.begin();) add(*--it, right);
  if (hull.count > 1) --hull.count;  // the first corner is repeated at the end
  return hull;
}

PixelRange LightPixels::rows_of(const PixelHull& hull) const {
  if (hull.everywhere) return {0, rows_ - 1};
  double from = std::numeric_limits<double>::max(), to = -from;
  for (std::size_t i = 0; i < hull.count; ++i) {
    from = std::min(from, hull.corners[i].y);
    to = std::max(to, hull.corners[i].y);
  }
  return range_of(from - hull.margin, to + hull.margin, rows_);
}

/// The hull enlarged by its margin reaches a row where the hull itself comes within the margin of that row. The part of
/// an edge in a row has an error of a few roundings of the edge's extent, which the margin includes, too.
PixelRange LightPixels::columns_of(const PixelHull& hull, std::uint32_t row) const {
  if (hull.everywhere) return {0, columns_ - 1};
  const double low = row == 0 ? -std::numeric_limits<double>::max() : row - 2 * hull.margin,
               high = row + 1 == rows_ ? std::numeric_limits<double>::max() : row + 1 + 2 * hull.margin;
  double from = std::numeric_limits<double>::max(), to = -from;
  const auto include = [&](double x) {
    from = std::min(from, x);
    to = std::max(to, x);
  };
  for (std::size_t i = 0; i < hull.count; ++i) {
    glm::dvec2 a = hull.corners[i], b = hull.corners[(i + 1) % hull.count];
    if (a.y > b.y) std::swap(a, b);
    if (b.y < low || a.y > high) continue;
    const auto at = [&](double y) { return a.x + (b.x - a.x) * std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0); };
    include(a.y < low ? at(low) : a.x);
    include(b.y > high ? at(high) : b.x);
  }
  return range_of(from - 2 * hull.margin, to + 2 * hull.margin, columns_);
}

}  // namespace penumbra::pairs
