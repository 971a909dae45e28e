#pragma once

#include "visibility/light_texture.hpp"

#include <memory>

namespace penumbra::areas {

/// A part of a light between two of its rows, in its coordinates: s of its two sides at both.
struct LevelTrapezoid {
  double low, high;  ///< t
  double low_left, low_right, high_left, high_right;
};

/// A texture's luminance integrated over parts of the light: as TextureMeasure does it, with rows for columns.
class TexturedPart {
 public:
  explicit TexturedPart(const visibility::LightTexture& texture);
  ~TexturedPart();
  TexturedPart(TexturedPart&&) noexcept;
  TexturedPart& operator=(TexturedPart&&) noexcept;

  /// The share of all. Off by its sums' rounding: 16 (width + height) · 2⁻⁵³ of the brightest texel over the mean.
  [[nodiscard]] double share_of(const LevelTrapezoid& part) const;
  /// The brightest texel over the mean.
  [[nodiscard]] double contrast() const { return contrast_; }
  [[nodiscard]] double rounding() const { return rounding_; }

 private:
  struct Rows;
  std::unique_ptr<const Rows> rows_;
  double contrast_ = 1, rounding_ = 0;
};

}  // namespace penumbra::areas
