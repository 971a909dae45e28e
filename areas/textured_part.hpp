// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_texture.hpp"

#include <memory>

namespace penumbra::areas {

/// Part of a light between two of its rows, in the light's coordinates: s of its two sides at both rows.
struct LevelTrapezoid {
  double low, high;  ///< t
  double low_left, low_right, high_left, high_right;
};

/// Integral of a texture's luminance over parts of the light: TextureMeasure with rows and columns exchanged.
class TexturedPart {
 public:
  explicit TexturedPart(const visibility::LightTexture& texture);
  ~TexturedPart();
  TexturedPart(TexturedPart&&) noexcept;
  TexturedPart& operator=(TexturedPart&&) noexcept;

  /// Returns the part's fraction of the whole integral. The error is the rounding of the sums: 16 (width + height) ·
  /// 2⁻⁵³ of the brightest texel over the mean.
  [[nodiscard]] double share_of(const LevelTrapezoid& part) const;
  /// Returns the brightest texel's luminance over the mean.
  [[nodiscard]] double contrast() const { return contrast_; }
  [[nodiscard]] double rounding() const { return rounding_; }

 private:
  struct Rows;
  std::unique_ptr<const Rows> rows_;
  double contrast_ = 1, rounding_ = 0;
};

}  // namespace penumbra::areas
