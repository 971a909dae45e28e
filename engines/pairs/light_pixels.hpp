// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::pairs {

/// A convex region of the plane of light pixels: the hull of some points, each with an error of at most `error`.
struct Footprint {
  static constexpr std::size_t kMost = 32;

  std::array<glm::dvec2, kMost> points;
  std::size_t count = 0;
  double error = 0;
  bool everywhere = false;  ///< true if the region is unbounded

  void add(const glm::dvec2& point) { points[count++] = point; }
};

/// The hull of a footprint's points in light pixels: counter-clockwise, with a margin.
struct PixelHull {
  std::array<glm::dvec2, Footprint::kMost + 1> corners;
  std::size_t count = 0;
  double margin = 0;
  bool everywhere = false;
};

/// Pixels from `first` to `last`, both included; none if first > last.
struct PixelRange {
  std::uint32_t first = 1, last = 0;
  [[nodiscard]] bool none() const { return first > last; }
};

/// The irregular z-buffer's light pixels: a window around the places of view samples in a plane, cut into a grid, with
/// a list of the places in each pixel (count, prefix sum, scatter: Sintorn et al. 2008, section 4.1; memory is linear
/// in the view samples). The pixels that a footprint touches are found conservatively: every pixel with a place in the
/// footprint is in the result, regardless of rounding.
class LightPixels {
 public:
  LightPixels() = default;
  /// `error`: the largest error of a place. There are about `per_pixel` places in each pixel.
  LightPixels(std::span<const glm::dvec2> places, double error, double per_pixel);

  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  [[nodiscard]] const glm::dvec2& lower() const { return lower_; }
  [[nodiscard]] const glm::dvec2& upper() const { return upper_; }
  /// Returns the indices of the places in a pixel. The code that handles the pixel may reorder them.
  [[nodiscard]] std::span<std::uint32_t> list(std::uint32_t row, std::uint32_t column) {
    const std::size_t pixel = std::size_t{row} * columns_ + column;
    return std::span(numbers_).subspan(begin_[pixel], begin_[pixel + 1] - begin_[pixel]);
  }
  [[nodiscard]] std::size_t longest_list() const { return longest_; }
  [[nodiscard]] std::uint64_t bytes() const {
    return (begin_.capacity() + numbers_.capacity()) * sizeof(std::uint32_t);
  }

  [[nodiscard]] PixelHull hull_of(const Footprint& footprint) const;
  [[nodiscard]] PixelRange rows_of(const PixelHull& hull) const;
  [[nodiscard]] PixelRange columns_of(const PixelHull& hull, std::uint32_t row) const;

 private:
  [[nodiscard]] std::uint32_t pixel_of(const glm::dvec2& place) const;

  glm::dvec2 lower_{0}, upper_{0}, scale_{0};
  double error_ = 0;  // error of a place and of its pixel, in light pixels
  std::uint32_t columns_ = 0, rows_ = 0;
  std::size_t longest_ = 0;
  std::vector<std::uint32_t> begin_, numbers_;
};

}  // namespace penumbra::pairs
