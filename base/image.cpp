// SPDX-License-Identifier: Apache-2.0
// Converts linear values to bytes of sRGB (IEC 61966-2-1) and back, in double.

#include "base/image.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra {

std::uint8_t srgb_byte(float linear) {
  if (!(linear > 0)) return 0;  // negative and NaN
  const double value = std::min(1.0, static_cast<double>(linear));
  const double encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(encoded * 255));
}

double linear_of_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Image8 to_srgb(std::uint32_t width, std::uint32_t height, std::span<const glm::vec3> linear, float exposure) {
  PENUMBRA_ASSERT(linear.size() == std::size_t{width} * height, "{} pixels for {}x{}", linear.size(), width, height);
  Image8 image{width, height, {}};
  image.pixels.reserve(linear.size());
  for (const glm::vec3& color : linear) {
    image.pixels.push_back(
        {srgb_byte(color.r * exposure), srgb_byte(color.g * exposure), srgb_byte(color.b * exposure)});
  }
  return image;
}

}  // namespace penumbra
