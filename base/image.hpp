// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

/// One sRGB-encoded colour, red green blue, as screens and PNG files use it.
using Color8 = std::array<std::uint8_t, 3>;

/// A picture for display, in scan-line order from the top left. Measurements stay in floats (base/exr.hpp).
struct Image8 {
  std::uint32_t width = 0, height = 0;
  std::vector<Color8> pixels;
};

/// A picture in linear light, in scan-line order from the top left: the texture of a light or a surface.
struct LinearImage {
  std::uint32_t width = 0, height = 0;
  std::vector<glm::vec3> pixels;  ///< red green blue, primaries of Rec. 709
};

/// A picture as stored in its file, with alpha: red green blue (sRGB) and alpha, in scan-line order from the top left.
struct RgbaImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 4>> pixels;
};

/// Returns the linear value of an sRGB-encoded one, both in [0, 1].
double linear_of_srgb(double encoded);

/// Returns the sRGB encoding (IEC 61966-2-1) of a linear value, clamped to [0, 1] and rounded; NaN gives 0.
std::uint8_t srgb_byte(float linear);

/// Returns linear radiance, multiplied by `exposure`, as a picture. `linear` has width × height pixels.
Image8 to_srgb(std::uint32_t width, std::uint32_t height, std::span<const glm::vec3> linear, float exposure = 1);

}  // namespace penumbra
