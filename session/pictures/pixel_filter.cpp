// SPDX-License-Identifier: Apache-2.0
// Computes weights of pixel filters. Blackman-Harris: Harris, "On the use of windows for harmonic analysis with the
// discrete Fourier transform", Proc. IEEE 66 (1978), the four terms of at most −92 dB; over both axes, as in Blender's
// Cycles.

#include "session/pictures/pixel_filter.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "session/parse.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::session {

double PixelFilter::share(double offset) const {
  if (!(std::abs(offset) < reach())) return 0;
  if (kind == Kind::box) return 1;
  const double turn = 2 * std::numbers::pi * (std::abs(offset) / (2 * reach()) + 0.5);  // the same on both sides
  return 0.35875 - 0.48829 * std::cos(turn) + 0.14128 * std::cos(2 * turn) - 0.01168 * std::cos(3 * turn);
}

PixelFilter parse_filter(const std::string& name, const std::string& width) {
  if (name.empty() || name == "box") {
    if (!width.empty())
      throw UsageError("--filter-width {}: only for --pixel-filter blackman-harris; a box is one pixel wide", width);
    return {};
  }
  if (name != "blackman-harris") throw UsageError("--pixel-filter {}: expected box or blackman-harris", name);
  const auto pixels = parse_number(width.empty() ? "1.5" : width);
  if (!pixels || !(*pixels >= 1 && *pixels <= 10))
    throw UsageError("--filter-width {}: expected pixels from 1 to 10, such as 1.5", width);
  return {PixelFilter::Kind::blackman_harris, *pixels};
}

std::vector<FilterTaps> filter_taps(const PixelFilter& filter, std::size_t pixels, std::size_t side) {
  const auto samples = static_cast<std::ptrdiff_t>(pixels * side), step = static_cast<std::ptrdiff_t>(side);
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(filter.reach() * static_cast<double>(side)));
  std::vector<FilterTaps> all(pixels);
  for (std::ptrdiff_t pixel = 0; pixel < static_cast<std::ptrdiff_t>(pixels); ++pixel) {
    FilterTaps& taps = all[static_cast<std::size_t>(pixel)];
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(pixel * step - reach, 0);
    const std::ptrdiff_t end = std::min((pixel + 1) * step + reach, samples);
    for (std::ptrdiff_t i = first; i < end; ++i) {
      // Distances are in halves of a view sample's distance, which are integers: both sides of the centre get the same
      // weight.
      const std::ptrdiff_t halves = 2 * i + 1 - (2 * pixel + 1) * step;
      const double share = filter.share(static_cast<double>(halves) / static_cast<double>(2 * side));
      if (share <= 0) continue;
      if (taps.shares.empty()) taps.first = static_cast<std::size_t>(i);
      taps.shares.push_back(share);
    }
    PENUMBRA_ASSERT(!taps.shares.empty(), "pixel {} of {} has no view sample within {}", pixel, pixels, filter.width);
  }
  return all;
}

}  // namespace penumbra::session
