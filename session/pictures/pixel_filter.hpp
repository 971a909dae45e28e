// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::session {

/// Weight of a view sample for a pixel, by its distance from the pixel's centre: the product of the weights of both
/// axes.
struct PixelFilter {
  enum class Kind : std::uint8_t { box, blackman_harris };
  Kind kind = Kind::box;
  /// Width in pixels. A box is one pixel wide; Blackman-Harris reaches this far to each side of the centre, as Cycles'
  /// filter of that width does.
  double width = 1;

  /// Returns the distance from the centre, in pixels, beyond which weights are 0.
  [[nodiscard]] double reach() const { return kind == Kind::box ? width / 2 : width; }
  /// Returns the weight along one axis, not normalized; `offset` in pixels.
  [[nodiscard]] double share(double offset) const;
};

/// Parses --pixel-filter and --filter-width; an empty text was not given. Throws UsageError if invalid.
PixelFilter parse_filter(const std::string& name, const std::string& width);

/// View samples of a line with an effect on one of its pixels: neighbouring samples, each with its weight.
struct FilterTaps {
  std::size_t first = 0;
  std::vector<double> shares;
};

/// Returns the taps of each of `pixels` in a line. Each pixel has `side` view samples, at the middles of its equal
/// parts. There are no samples beyond the line's ends: pixels there have fewer.
std::vector<FilterTaps> filter_taps(const PixelFilter& filter, std::size_t pixels, std::size_t side);

}  // namespace penumbra::session
