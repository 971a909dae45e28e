// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "areas/area_sweep.hpp"
#include "visibility/light_texture.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

// Luminance of a texture integrated over a region of the light, for the sweep. Internal to areas/.

namespace penumbra::areas {

/// Columns of a texture as sums from t = −1 upward, so that an integral between two heights is a difference.
class TextureColumns {
 public:
  TextureColumns() = default;
  explicit TextureColumns(const visibility::LightTexture& texture);

  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint32_t height() const { return height_; }
  /// Returns the sum of the luminance of the lowest `row` texels of column x: in double, off by less than 2048 · 2⁻⁵³
  /// of it.
  [[nodiscard]] double up_to(std::uint32_t x, std::uint32_t row) const {
    return up_to_[std::size_t{x} * (height_ + 1) + row];
  }
  /// Returns ∫∫ luminance ds dt over the whole light, of the stored sums.
  [[nodiscard]] const mpq_class& integral() const { return integral_; }

 private:
  std::uint32_t width_ = 0, height_ = 0;
  std::vector<double> up_to_;
  mpq_class integral_;
};

/// Measures ∫ luminance instead of area. The sweep cuts its strips at the borders between columns. In a strip, the
/// integral under an edge at height t is F(t), the column's luminance from −1 to t: linear within each texel, whose
/// borders cut the slab in pieces over which the mean of F is its value in the middle. The only assumption is that the
/// edges are straight.
template <typename Number>
class TextureMeasure {
 public:
  static constexpr bool kNeedsEnds = true;

  explicit TextureMeasure(const TextureColumns& columns) : columns_(&columns) {}

  void add_breaks(std::vector<Number>& breaks) const {
    if (breaks.empty()) return;
    const auto [least, largest] = std::minmax_element(breaks.begin(), breaks.end());
    const Number low = *least, high = *largest;
    for (std::uint32_t x = 1; x < columns_->width(); ++x) {
      const Number s = Number(2 * x) / Number(columns_->width()) - 1;
      if (s > low && s < high) breaks.push_back(s);
    }
  }

  void enter_strip(const Number& middle) { column_ = cell((middle + 1) / 2 * columns_->width(), columns_->width()); }

  void enter_slab(const Number& /*from*/, const Number& /*to*/) {}

  [[nodiscard]] Number between(const ActiveEdge<Number>& low, const ActiveEdge<Number>& high) const {
    return mean_under(high) - mean_under(low);
  }

 private:
  /// Returns the index of the cell [0, 1), [1, 2) … that contains `at`, clamped.
  static std::uint32_t cell(const double& at, std::uint32_t count) {
    return static_cast<std::uint32_t>(std::clamp(std::floor(at), 0.0, count - 1.0));
  }
  static std::uint32_t cell(const mpq_class& at, std::uint32_t count) {
    if (at <= 0) return 0;
    if (at >= count) return count - 1;
    return static_cast<std::uint32_t>(mpz_class(at.get_num() / at.get_den()).get_ui());
  }

  /// Returns F, with heights and F in rows, for a height within texel `row`.
  [[nodiscard]] Number under(const Number& height, std::uint32_t row) const {
    const Number below = columns_->up_to(column_, row), above = columns_->up_to(column_, row + 1);
    return below + (height - row) * (above - below);
  }

  /// Returns the mean of F over the slab, under one edge.
  [[nodiscard]] Number mean_under(const ActiveEdge<Number>& edge) const {
    const std::uint32_t rows = columns_->height();
    const Number first = rows_at(edge.from), last = rows_at(edge.to);
    const Number &low = std::min(first, last), &high = std::max(first, last);
    const Number length = high - low;
    const std::uint32_t from = cell(low, rows), to = cell(high, rows);
    if (from == to) return under((low + high) / 2, from) * 2 / rows;
    Number sum = 0, at = low;
    for (std::uint32_t row = from; row <= to; ++row) {
      const Number next = row == to ? high : Number(row + 1);
      sum += (next - at) * under((at + next) / 2, row);
      at = next;
    }
    return sum / length * 2 / rows;
  }

  /// Returns the height in texels from below, clamped to the texture.
  [[nodiscard]] Number rows_at(const Number& t) const {
    const Number top = columns_->height();
    const Number at = (t + 1) / 2 * columns_->height();
    return std::clamp(at, Number(0), top);
  }

  const TextureColumns* columns_;
  std::uint32_t column_ = 0;
};

}  // namespace penumbra::areas
