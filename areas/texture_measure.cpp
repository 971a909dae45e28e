// SPDX-License-Identifier: Apache-2.0
// Computes prefix sums of a texture's columns for TextureMeasure.

#include "areas/texture_measure.hpp"

namespace penumbra::areas {

TextureColumns::TextureColumns(const visibility::LightTexture& texture)
    : width_(texture.width), height_(texture.height) {
  up_to_.reserve(std::size_t{width_} * (height_ + 1));
  for (std::uint32_t x = 0; x < width_; ++x) {
    double sum = 0;
    up_to_.push_back(sum);
    for (std::uint32_t row = 0; row < height_; ++row) {
      sum += texture.luminance[std::size_t{height_ - 1 - row} * width_ + x];
      up_to_.push_back(sum);
    }
    integral_ += mpq_class(sum);
  }
  integral_ *= mpq_class(4) / (mpz_class(width_) * height_);
}

}  // namespace penumbra::areas
