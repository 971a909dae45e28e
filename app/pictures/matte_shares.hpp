#pragma once

#include "app/pictures/pixel_filter.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace penumbra::app {

/// How much of each pixel each name has, over all of its view samples, weighed by the filter that weighs colours.
class MatteShares {
 public:
  struct Share {
    std::uint32_t name = 0;  ///< index into names()
    float part = 0;          ///< of the pixel: 1 if nothing else is in it
  };

  MatteShares(std::uint32_t width, std::uint32_t height, const PixelFilter& filter);
  /// A picture of `side` times the width and height: of each view sample an index into `names`, or Surfaces::kNothing.
  /// Equal names are one.
  void add(std::span<const std::string> names, std::span<const std::uint32_t> of_sample, std::uint32_t side);

  [[nodiscard]] std::span<const std::string> names() const& { return names_; }
  std::span<const std::string> names() const&& = delete;
  [[nodiscard]] std::size_t pixel_count() const { return std::size_t{width_} * rows_.size(); }
  /// What is in a pixel, the largest first; nothing is not among it.
  [[nodiscard]] std::vector<Share> of_pixel(std::size_t pixel) const;

 private:
  /// Of a row of pixels: those of pixel x are shares[ends[x − 1]] to before shares[ends[x]], sums of shares so far.
  struct Row {
    std::vector<std::uint32_t> ends;
    std::vector<Share> shares;
  };
  void add_row(std::size_t y, std::span<const std::uint32_t> of_sample, std::uint32_t side, const FilterTaps& down,
               std::span<const FilterTaps> across);

  std::uint32_t width_;
  PixelFilter filter_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<Row> rows_;
};

}  // namespace penumbra::app
