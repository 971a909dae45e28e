#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::app {

/// How much a view sample counts for a pixel, by how far it is from the pixel's centre: the shares of both axes
/// multiply.
struct PixelFilter {
  enum class Kind : std::uint8_t { box, blackman_harris };
  Kind kind = Kind::box;
  double width = 1;  ///< of all of it, in pixels; a box is one pixel wide

  /// Its share along one axis, not normalized; `offset` in pixels.
  [[nodiscard]] double share(double offset) const;
};

/// --pixel-filter and --filter-width; what is empty was not said. Throws UsageError.
PixelFilter parse_filter(const std::string& name, const std::string& width);

/// What counts for a pixel of a line of them: neighbouring view samples, each with its share.
struct FilterTaps {
  std::size_t first = 0;
  std::vector<double> shares;
};

/// For each of `pixels` in a line with `side` view samples in each, in the middles of equal parts. Beyond the line's
/// ends there is nothing: pixels there have fewer.
std::vector<FilterTaps> filter_taps(const PixelFilter& filter, std::size_t pixels, std::size_t side);

}  // namespace penumbra::app
