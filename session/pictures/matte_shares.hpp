// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/pictures/picture_mean.hpp"
#include "session/pictures/pixel_filter.hpp"
#include "session/pictures/surfaces.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace penumbra::session {

/// Fraction of each pixel for each name, over all of the pixel's view samples, with the filter's weights of colours.
class MatteShares {
 public:
  struct Share {
    std::uint32_t name = 0;  ///< index into names()
    float part = 0;          ///< fraction of the pixel: 1 if there is no other name
  };

  MatteShares(std::uint32_t width, std::uint32_t height, const PixelFilter& filter);
  /// Adds rows of a picture of `side` times the width and height, as PictureMean::add does: for each view sample an
  /// index into `names`, or Surfaces::kNothing. Equal names are one.
  void add(std::span<const std::string> names, std::span<const std::uint32_t> of_sample, std::uint32_t side,
           const PictureBand& band);

  [[nodiscard]] std::span<const std::string> names() const& { return names_; }
  std::span<const std::string> names() const&& = delete;
  /// Orders each pixel's names, and makes their parts fractions; to be called once, after all calls of add().
  void settle();
  /// Returns the names in a pixel, the largest first; background is not included. To be called after settle().
  [[nodiscard]] std::span<const Share> of_pixel(std::size_t x, std::size_t y) const& {
    const Row& row = rows_[y];
    const std::size_t begin = x == 0 ? 0 : row.ends[x - 1];
    const auto shares = std::span(row.shares).subspan(begin, row.ends[x] - begin);
    return shares.first(shares.size() - (shares.back().name == kNothing ? 1 : 0));
  }
  std::span<const Share> of_pixel(std::size_t, std::size_t) const&& = delete;
  [[nodiscard]] std::uint32_t width() const { return width_; }

 private:
  static constexpr std::uint32_t kNothing = Surfaces::kNothing;  ///< comes last in settled shares

  /// Row of pixels: the shares of pixel x, at least one, begin at shares[ends[x − 1]] and end before shares[ends[x]].
  /// Their parts are running sums until settle().
  struct Row {
    std::vector<std::uint32_t> ends;
    std::vector<Share> shares;
  };
  /// `down`: taps whose `first` counts from the first given row of view samples.
  void add_row(std::size_t y, std::span<const std::uint32_t> of_sample, std::uint32_t side, const FilterTaps& down,
               std::span<const FilterTaps> across);

  std::uint32_t width_;
  PixelFilter filter_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<Row> rows_;
};

}  // namespace penumbra::session
