// SPDX-License-Identifier: Apache-2.0
// Texture of a rectangle light: luminance, texel look-up, and weights of light samples that add up to exactly 1.

#include "visibility/light_texture.hpp"

#include "base/assert.hpp"
#include "base/error.hpp"
#include "visibility/dome_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace penumbra::visibility {
namespace {

/// Returns which of `count` equal cells of [0, 1] contains `share`.
std::uint32_t cell_at(double share, std::uint32_t count) {
  const double cell = std::floor(share * count);
  return static_cast<std::uint32_t>(std::clamp(cell, 0.0, static_cast<double>(count - 1)));
}

}  // namespace

std::size_t LightTexture::texel_at(const glm::dvec2& st) const {
  const std::uint32_t x = cell_at((st.x + 1) / 2, width), y = cell_at((1 - st.y) / 2, height);
  return std::size_t{y} * width + x;
}

LightTexture make_light_texture(const scenes::Texture& source) {
  LightTexture texture;
  texture.width = source.width;
  texture.height = source.height;
  texture.colors = source.texels;
  PENUMBRA_ASSERT(!texture.colors.empty() && texture.colors.size() == std::size_t{source.width} * source.height,
                  "{} texels for {}x{}", texture.colors.size(), source.width, source.height);
  for (const glm::vec3& color : texture.colors) texture.luminance.push_back(luminance_of(glm::dvec3(color)));
  texture.mean_luminance = std::accumulate(texture.luminance.begin(), texture.luminance.end(), 0.0) /
                           static_cast<double>(texture.luminance.size());
  return texture;
}

std::vector<double> sample_weights(const LightTexture& texture, const std::vector<glm::dvec2>& coordinates,
                                   const std::string& light) {
  std::vector<double> up_to;  // Σ luminance of the samples 0 … j
  double sum = 0;
  for (const glm::dvec2& st : coordinates) up_to.push_back(sum += texture.luminance[texture.texel_at(st)]);
  if (!(sum > 0)) {
    throw InputError(
        "light \"{}\": all {} light samples lie on black texels of its {}x{} texture; take more --light-samples or a "
        "coarser texture",
        light, coordinates.size(), texture.width, texture.height);
  }
  // Sums, not weights, are rounded to multiples of kStep, so that weights add up to exactly 1. Neighbouring sums share
  // their rounding except for the last addition, division and step: four steps at most; `sum` itself is off by 4096 ·
  // 2⁻⁵³ of its size.
  constexpr double kStep = 0x1p-52;
  std::vector<double> weights;
  double before = 0;
  for (const double& to_here : up_to) {
    const double rounded = std::round(to_here / sum / kStep) * kStep;
    weights.push_back(rounded - before);
    before = rounded;
  }
  return weights;
}

}  // namespace penumbra::visibility
