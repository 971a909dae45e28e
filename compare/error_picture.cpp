// SPDX-License-Identifier: Apache-2.0
// Paints errors and V of each pixel by colour scales, and computes the exposure of pictures.

#include "compare/error_picture.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace penumbra::compare {
namespace {

// Colours from zero to the largest error, evenly spaced: two arms of a diverging scale (after ColorBrewer's RdBu),
// distinguishable without red or green vision.
constexpr std::array<Color8, 5> kTooBright{
    {{255, 255, 255}, {188, 218, 236}, {90, 163, 206}, {33, 102, 172}, {5, 40, 90}}};
constexpr std::array<Color8, 5> kTooDark{
    {{255, 255, 255}, {253, 208, 180}, {240, 130, 95}, {190, 35, 45}, {95, 0, 25}}};

void check_sizes(const visibility::ViewSamples& samples, std::span<const float> values) {
  PENUMBRA_ASSERT(samples.size() == std::size_t{samples.width} * samples.height && samples.size() == values.size(),
                  "{} values for {} view samples of {}x{} pixels", values.size(), samples.size(), samples.width,
                  samples.height);
}

/// Returns a picture of `value_of(i)` in `color_of(value)` for each pixel except background. NaN, the mark of a pixel
/// that was not evaluated, is painted as background.
template <typename ValueOf, typename ColorOf>
Image8 paint(const visibility::ViewSamples& samples, ValueOf value_of, ColorOf color_of) {
  Image8 image{samples.width, samples.height, std::vector<Color8>(samples.size(), kBackgroundColor)};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double value = value_of(i);
    if (samples.triangle[i] != visibility::ViewSamples::kBackground && !std::isnan(value))
      image.pixels[i] = color_of(value);
  }
  return image;
}

}  // namespace

std::span<const Color8> error_colors(bool too_bright) {
  return too_bright ? kTooBright : kTooDark;
}

Color8 error_color(double error, double limit) {
  const std::span<const Color8> arm = error_colors(error > 0);
  const double depth = std::sqrt(std::min(1.0, std::abs(error) / limit)) * static_cast<double>(arm.size() - 1);
  const std::size_t from = std::min(static_cast<std::size_t>(depth), arm.size() - 2);
  const double share = depth - static_cast<double>(from);
  Color8 color;
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] = static_cast<std::uint8_t>(std::lround(arm[from][c] * (1 - share) + arm[from + 1][c] * share));
  }
  return color;
}

double error_scale_limit(double largest) {
  for (const double limit : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5}) {
    if (largest <= limit) return limit;
  }
  return 1;
}

Image8 error_picture(const visibility::ViewSamples& samples, std::span<const float> visibility,
                     std::span<const float> reference, double limit) {
  check_sizes(samples, visibility);
  check_sizes(samples, reference);
  return paint(
      samples, [&](std::size_t i) { return static_cast<double>(visibility[i]) - static_cast<double>(reference[i]); },
      [&](double error) { return error_color(error, limit); });
}

Image8 visibility_picture(const visibility::ViewSamples& samples, std::span<const float> visibility) {
  check_sizes(samples, visibility);
  return paint(
      samples, [&](std::size_t i) { return static_cast<double>(visibility[i]); },
      [](double value) {
        // sRGB bytes are already perceptually spaced: V = 0.5 is shown as middle grey.
        const auto grey = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
        return Color8{grey, grey, grey};
      });
}

float auto_exposure(std::span<const glm::vec3> linear, std::span<const std::uint8_t> left_out) {
  // Positive floats are ordered like their bits: finds the upper half of the percentile's bits first, then the lower
  // half.
  constexpr std::uint32_t kHalf = 16;
  const auto counts_of_halves = [&](std::uint32_t shift, std::uint32_t above) {
    std::vector<std::size_t> counts(std::size_t{1} << kHalf);
    for (std::size_t i = 0; i < linear.size(); ++i) {
      if (!left_out.empty() && left_out[i] != 0) continue;
      const float largest = std::max({linear[i].r, linear[i].g, linear[i].b});
      const auto bits = std::bit_cast<std::uint32_t>(largest);
      if (largest > 0 && std::isfinite(largest) && (shift != 0 || bits >> kHalf == above))
        ++counts[bits >> shift & ((1u << kHalf) - 1)];
    }
    return counts;
  };
  const auto find = [](std::span<const std::size_t> counts, std::size_t& place) {
    std::uint32_t half = 0;
    for (; place >= counts[half]; ++half) place -= counts[half];
    return half;
  };
  const std::vector<std::size_t> counts = counts_of_halves(kHalf, 0);
  const std::size_t count = std::reduce(counts.begin(), counts.end());
  if (count == 0) {
    const auto is_black = [&](const glm::vec3& color) {
      return color == glm::vec3(0) || left_out[static_cast<std::size_t>(&color - linear.data())] != 0;
    };
    const bool others_are_black = !left_out.empty() && std::ranges::all_of(linear, is_black);
    return others_are_black ? auto_exposure(linear) : 1;
  }
  std::size_t place = (count - 1) * 99 / 100;
  const std::uint32_t upper = find(counts, place), lower = find(counts_of_halves(0, upper), place);
  return 0.9f / std::bit_cast<float>(upper << kHalf | lower);
}

}  // namespace penumbra::compare
