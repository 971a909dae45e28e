#pragma once

#include "visibility/light_texture.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::volumes {

/// Integrals of a rectangle light's texture over regions of [−1, 1]², exact up to rounding: the texture is constant
/// in each texel. The whole light weighs 1. By Green's theorem: with P(x, y) = ∫ weight from −1 to x, a region weighs
/// ∮ P dy around it. GLSL twin: texture_weights.glsl.
class TextureWeights {
 public:
  explicit TextureWeights(const visibility::LightTexture& texture);

  /// ∫ P dy along the segment.
  [[nodiscard]] double left_of(const glm::dvec2& from, const glm::dvec2& to) const;

  /// ∫ P dy along the rim, counter-clockwise from the corner (1, −1): as far as a fan of this area reaches, of 4 and
  /// from −1/2 on.
  [[nodiscard]] double up_to_fan(double fan) const { return along_rim(2 * fan + 1); }

  /// What an edge adds that is seen from `reference`, strictly inside: ∫ P dy around the cone over it, cut by the
  /// light, less the triangle, with the ways from its ends to the rim left out: at a vertex they add up to nothing.
  /// `side` is RadialCoverage::beyond's.
  struct Edge {
    glm::dvec2 from{0}, to{0};
    int side = 0;
  };
  [[nodiscard]] double beyond(const Edge& edge, const glm::dvec2& reference) const;

  /// As beyond(), but with the ways from the ends to the rim: the weight of what lies beyond this edge, whatever other
  /// edges add.
  [[nodiscard]] double weight_beyond(const Edge& edge, const glm::dvec2& reference) const;

  /// Of a polygon within the light, counter-clockwise.
  [[nodiscard]] double weight_of(std::span<const glm::dvec2> polygon) const;

  /// The brightest texel's luminance over the mean: a region of area A weighs at most A · brightest() / 4, so an error
  /// of an area grows by no more than that.
  [[nodiscard]] double brightest() const { return brightest_; }

  /// What the shader reads: weight below each row's lower border, then P and PP = ∫ P of each row at each border.
  [[nodiscard]] const std::vector<double>& words() const { return words_; }
  /// WedgePush::texels.
  [[nodiscard]] std::uint32_t texels() const { return width_ | height_ << 16; }

 private:
  [[nodiscard]] double below(double y) const;
  [[nodiscard]] glm::dvec2 row_sums(std::uint32_t row, double x) const;
  [[nodiscard]] double along_rim(double position) const;

  std::uint32_t width_, height_;
  double brightest_ = 1;
  std::vector<double> words_;
};

/// The texture of part (column, row) of a rectangle cut in n × n: exactly, each texel cut in n × n itself.
visibility::LightTexture texture_part(const visibility::LightTexture& texture, std::uint32_t n, const glm::uvec2& part);

}  // namespace penumbra::volumes
