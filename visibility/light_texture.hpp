// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::visibility {

/// The texture of a rectangle light, constant in each texel. In the light's coordinates (s, t) in [−1, 1]² along
/// (halfU, halfV), texel (x, y) covers s from −1 + 2x / width to −1 + 2 (x + 1) / width and t from 1 − 2 (y + 1) /
/// height to 1 − 2y / height: rows run from the top, t = 1, downward.
struct LightTexture {
  std::uint32_t width = 0, height = 0;
  std::vector<glm::vec3> colors;  ///< linear, multiplies the light's radiance; texel (x, y) at y · width + x
  std::vector<double> luminance;  ///< of the colours, in the same order: Rec. 709's 0.2126 R + 0.7152 G + 0.0722 B
  /// Mean of the luminance. Its integral over the light is mean · area, over the coordinates 4 · mean. Above 0.
  double mean_luminance = 0;

  /// Returns the texel at (s, t), which is clamped to [−1, 1]². On a border between texels: the one to the right, or
  /// below.
  [[nodiscard]] std::size_t texel_at(const glm::dvec2& st) const;
};

LightTexture make_light_texture(const scenes::Texture& source);

/// Returns the weight of each light sample in V: the luminance of its texel over the sum of all. Every weight is a
/// multiple of 2⁻⁵² and they add up to exactly 1, so that sums of weights do not depend on their order; each is off by
/// less than 2⁻⁴⁰. Throws InputError if all samples are on black texels; `light` is its name in the message.
std::vector<double> sample_weights(const LightTexture& texture, const std::vector<glm::dvec2>& coordinates,
                                   const std::string& light);

}  // namespace penumbra::visibility
