// SPDX-License-Identifier: Apache-2.0
// Sorts the light samples into bands across the light (bucket sort), for queries by rectangle.

#include "maps/backprojection/patches/light_sample_bands.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

namespace penumbra::maps {

std::vector<std::uint32_t> light_sample_bands(const visibility::Light& light, const LightBasis& basis) {
  std::vector<glm::vec2> points;
  for (const glm::vec3& point : light.points) points.emplace_back(basis.local(point));
  const auto count = static_cast<std::uint32_t>(points.size());
  gpu::SampleBandsHead head{count, 0, 0, 0};
  head.bands = light.rows > 0 ? light.rows : static_cast<std::uint32_t>(std::lround(std::sqrt(count)));
  head.bands = std::max(head.bands, 1u);
  const LightBounds bounds = light_bounds(light, basis);
  head.lower = static_cast<float>(bounds.lower.y);
  head.per_unit = static_cast<float>(head.bands / (bounds.upper.y - bounds.lower.y));
  // Same operations as in sample_bands.glsl: a difference and a product, each rounded to float.
  const auto band_of = [&](float y) {
    const float from_lower = y - head.lower;
    const float band = std::floor(from_lower * head.per_unit);
    return static_cast<std::uint32_t>(std::clamp(band, 0.0F, static_cast<float>(head.bands - 1)));
  };
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&](std::uint32_t i, std::uint32_t j) {
    return std::tuple(band_of(points[i].y), points[i].x, i) < std::tuple(band_of(points[j].y), points[j].x, j);
  });

  std::vector<std::uint32_t> words = push_words(head);
  const auto put = [&words](float number) { words.push_back(std::bit_cast<std::uint32_t>(number)); };
  for (const glm::vec2& point : points) {
    put(point.x);
    put(point.y);
  }
  std::uint32_t first = 0;
  for (std::uint32_t band = 0; band <= head.bands; ++band) {
    while (first < count && band_of(points[order[first]].y) < band) ++first;
    words.push_back(first);
  }
  for (const std::uint32_t i : order) {
    put(points[i].x);
    put(points[i].y);
    words.push_back(i);
  }
  return words;
}

void LightSampleBands::record(render::Commands& /*commands*/, const MapSet& maps) {
  const std::vector<std::uint32_t> words = light_sample_bands(maps.light, maps.basis);
  render::grow(*device_, bands_, "light sample bands", words.size() * sizeof(std::uint32_t));
  bands_->write<std::uint32_t>(words);
}

const render::Buffer& LightSampleBands::buffer() const {
  PENUMBRA_ASSERT(bands_ != nullptr, "{}", "the light's samples before the light");
  return *bands_;
}

}  // namespace penumbra::maps
