// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_texture.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// Integrals of a rectangle light's texture over regions of [−1, 1]², exact up to rounding: the texture is constant in
/// each texel. The whole light has weight 1. By Green's theorem: with P(x, y) = ∫ weight from −1 to x, a region weighs
/// ∮ P dy around the region. GLSL twin: texture_weights.glsl.
class TextureWeights {
 public:
  explicit TextureWeights(const visibility::LightTexture& texture);

  /// Returns ∫ P dy along the segment.
  [[nodiscard]] double left_of(const glm::dvec2& from, const glm::dvec2& to) const;

  /// Returns ∫ P dy along the rim, counter-clockwise from the corner (1, −1) to the end of a fan of area `fan`. Fans
  /// begin at −1/2, and the whole has area 4.
  [[nodiscard]] double up_to_fan(double fan) const { return along_rim(2 * fan + 1); }

  /// An edge, and the side as for RadialCoverage::beyond. beyond() returns the edge's contribution as seen from
  /// `reference`, strictly inside: ∫ P dy around the cone over the edge, cut by the light, minus the triangle. The
  /// segments from the edge's ends to the rim are omitted: they cancel at each vertex.
  struct Edge {
    glm::dvec2 from{0}, to{0};
    int side = 0;
  };
  [[nodiscard]] double beyond(const Edge& edge, const glm::dvec2& reference) const;

  /// Returns the same as beyond(), but with the segments from the ends to the rim: the weight of the region beyond this
  /// edge, independent of other edges.
  [[nodiscard]] double weight_beyond(const Edge& edge, const glm::dvec2& reference) const;

  /// Returns the weight of a polygon within the light, counter-clockwise.
  [[nodiscard]] double weight_of(std::span<const glm::dvec2> polygon) const;

  /// Returns the brightest texel's luminance over the mean: a region of area A weighs at most A · brightest() / 4, so
  /// an error of an area grows by no more than this factor.
  [[nodiscard]] double brightest() const { return brightest_; }

  /// Returns the shader's table: weight below each row's lower border, then P and PP = ∫ P of each row at each border.
  [[nodiscard]] const std::vector<double>& words() const { return words_; }
  /// Returns WedgePush::texels.
  [[nodiscard]] std::uint32_t texels() const { return width_ | height_ << 16; }

 private:
  [[nodiscard]] double below(double y) const;
  [[nodiscard]] glm::dvec2 row_sums(std::uint32_t row, double x) const;
  [[nodiscard]] double along_rim(double position) const;

  std::uint32_t width_, height_;
  double brightest_ = 1;
  std::vector<double> words_;
};

}  // namespace penumbra::volumes
