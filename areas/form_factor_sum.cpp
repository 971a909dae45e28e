// SPDX-License-Identifier: Apache-2.0
// Sums form factors of uncovered trapezoids in closed form (visibility/lights/form_factor.hpp), with a texture cut at
// blocks of texels. Not from a paper.

#include "areas/form_factor_sum.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace penumbra::areas {
namespace {

/// Convex polygon: a polygon of four corners cut by up to four lines, each of which adds at most one corner.
struct Corners {
  std::array<glm::dvec2, 8> at{};
  std::size_t count = 0;
  void push(const glm::dvec2& corner) {
    PENUMBRA_ASSERT(count < at.size(), "{} corners", count);
    at[count++] = corner;
  }
  [[nodiscard]] std::span<const glm::dvec2> span() const { return std::span(at).first(count); }
};

Corners corners_of(std::span<const glm::dvec2> polygon) {
  Corners corners;
  for (const glm::dvec2& corner : polygon) corners.push(corner);
  return corners;
}

enum Axis : int { kS, kT };
/// Returns the part of the polygon with sign · (s − border) ≥ 0, or t in place of s.
Corners clip(const Corners& polygon, Axis axis, double border, double sign) {
  Corners inside;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec2 &a = polygon.at[i], &b = polygon.at[i + 1 < polygon.count ? i + 1 : 0];
    const double at_a = sign * (a[axis] - border), at_b = sign * (b[axis] - border);
    if (at_a >= 0) inside.push(a);
    if ((at_a >= 0) == (at_b >= 0)) continue;
    glm::dvec2 cut = a + at_a / (at_a - at_b) * (b - a);
    cut[axis] = border;
    inside.push(cut);
  }
  return inside;
}

}  // namespace

TextureBlocks::TextureBlocks(const visibility::LightTexture& texture)
    : width_(texture.width),
      height_(texture.height),
      across_((width_ + kMost - 1) / kMost),
      down_((height_ + kMost - 1) / kMost),
      columns_((width_ + across_ - 1) / across_),
      rows_((height_ + down_ - 1) / down_),
      colors_(std::size_t{columns_} * rows_, glm::dvec3(0)) {
  std::vector<double> counts(colors_.size());
  for (std::uint32_t y = 0; y < height_; ++y) {
    for (std::uint32_t x = 0; x < width_; ++x) {
      const std::size_t block = std::size_t{y / down_} * columns_ + x / across_;
      colors_[block] += glm::dvec3(texture.colors[std::size_t{y} * width_ + x]);
      counts[block] += 1;
    }
  }
  for (std::size_t i = 0; i < colors_.size(); ++i) colors_[i] /= counts[i];
}

std::uint32_t TextureBlocks::column_at(double s) const {
  return static_cast<std::uint32_t>(std::clamp(std::floor((s + 1) / 2 * width_), 0.0, width_ - 1.0)) / across_;
}

std::uint32_t TextureBlocks::row_at(double t) const {
  return static_cast<std::uint32_t>(std::clamp(std::floor((1 - t) / 2 * height_), 0.0, height_ - 1.0)) / down_;
}

void FormFactorSum::enter_slab(double from, double to) {
  add_ended();
  std::swap(before_, parts_);
  if (from != to_ || between_columns(from)) add_ended();
  from_ = from;
  to_ = to;
}

void FormFactorSum::add_between(const Side& low, const Side& high) {
  const auto same = [&](const Part& part) { return part.low == low.edge && part.high == high.edge; };
  const auto found = std::ranges::find_if(before_, same);
  Trapezoid shape{from_, to_, low.from, low.to, high.from, high.to};
  if (found != before_.end()) {
    shape.s0 = found->shape.s0;
    shape.low0 = found->shape.low0;
    shape.high0 = found->shape.high0;
    before_.erase(found);
  }
  parts_.push_back({low.edge, high.edge, shape});
}

void FormFactorSum::finish() {
  add_ended();
  std::swap(before_, parts_);
  add_ended();
  if (sky_) sum_ += sky_->take_form_factor(seen_.normal());
}

void FormFactorSum::add_ended() {
  for (const Part& part : before_) add(part.shape);
  before_.clear();
}

bool FormFactorSum::between_columns(double s) const {
  if (texture_ == nullptr) return false;
  const std::uint32_t x = texture_->column_at(s);  // a border may round into either of its columns
  return texture_->left(x) == s || texture_->left(x + 1) == s;
}

void FormFactorSum::add(const Trapezoid& shape) {
  const std::array<glm::dvec2, 4> corners{
      glm::dvec2(shape.s0, shape.low0), {shape.s1, shape.low1}, {shape.s1, shape.high1}, {shape.s0, shape.high0}};
  if (sky_) {
    sky_->add(corners, visibility::SkyPart::Level::s);
  } else if (texture_ == nullptr) {
    sum_ += seen_.part(corners);
  } else {
    add_blocks(texture_->column_at((corners[0].x + corners[1].x) / 2), corners);
  }
}

/// Cuts the polygon into strips at the borders between columns, from the left.
void FormFactorSum::add_polygon(std::span<const glm::dvec2> corners) {
  if (texture_ == nullptr) {
    sum_ += seen_.part(corners);
    return;
  }
  const auto [least, most] =
      std::ranges::minmax(corners, [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x; });
  Corners rest = corners_of(corners);
  const std::uint32_t last = texture_->column_at(most.x);
  for (std::uint32_t column = texture_->column_at(least.x); column < last; ++column) {
    const double border = texture_->left(column + 1);
    add_blocks(column, clip(rest, kS, border, -1).span());
    rest = clip(rest, kS, border, 1);
  }
  add_blocks(last, rest.span());
}

void FormFactorSum::add_whole() {
  if (sky_) {
    sky_->add_above(seen_.normal());
    sum_ += sky_->take_form_factor(seen_.normal());
    return;
  }
  if (texture_ == nullptr) {
    sum_ += seen_.whole();
    return;
  }
  for (std::uint32_t x = 0; x < texture_->columns(); ++x) add({texture_->left(x), texture_->left(x + 1), -1, -1, 1, 1});
}

/// Cuts the polygon into bands at the borders between rows, from the top, where row 0 is.
void FormFactorSum::add_blocks(std::uint32_t column, std::span<const glm::dvec2> corners) {
  if (corners.empty()) return;
  const auto [lowest, highest] =
      std::ranges::minmax(corners, [](const glm::dvec2& a, const glm::dvec2& b) { return a.y < b.y; });
  const std::uint32_t first = texture_->row_at(highest.y), last = texture_->row_at(lowest.y);
  Corners rest = corners_of(corners);
  for (std::uint32_t row = first; row <= last; ++row) {
    const double border = texture_->top(row + 1);
    const Corners band = row == last ? rest : clip(rest, kT, border, 1);
    sum_ += seen_.part(band.span()) * texture_->color(column, row);
    if (row != last) rest = clip(rest, kT, border, -1);
  }
}

}  // namespace penumbra::areas
