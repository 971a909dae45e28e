#pragma once

#include "visibility/light_texture.hpp"
#include "visibility/lights/unshadowed_light.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

// Form factors of what a sweep finds uncovered: the one here, and the one in volumes/scatter/.

namespace penumbra::areas {

/// A trapezoid of the light's plane with sides along t: at s0 from low0 to high0, at s1 from low1 to high1.
struct Trapezoid {
  double s0, s1, low0, low1, high0, high1;
};

/// A texture as form factors take it, whose every texel costs a polygon: texels, or of a texture with more than kMost
/// a side the means of blocks of them (the last column and row of blocks may be narrower).
class TextureBlocks {
 public:
  static constexpr std::uint32_t kMost = 64;

  explicit TextureBlocks(const visibility::LightTexture& texture);

  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  /// Where column x begins; the same number as the sweep's break there.
  [[nodiscard]] double left(std::uint32_t x) const { return 2.0 * std::min(x * across_, width_) / width_ - 1; }
  /// Where row y begins, from the top, t = 1, downward.
  [[nodiscard]] double top(std::uint32_t y) const { return 1 - 2.0 * std::min(y * down_, height_) / height_; }
  [[nodiscard]] std::uint32_t column_at(double s) const;
  [[nodiscard]] std::uint32_t row_at(double t) const;
  [[nodiscard]] const glm::dvec3& color(std::uint32_t x, std::uint32_t y) const {
    return colors_[std::size_t{y} * columns_ + x];
  }

 private:
  std::uint32_t width_, height_;  // in texels
  std::uint32_t across_, down_;   // texels of a block
  std::uint32_t columns_, rows_;  // of blocks
  std::vector<glm::dvec3> colors_;
};

/// Adds up form factors of parts of a light, times the colours of what they lie on. The sweep cuts its slabs wherever
/// any edge ends; trapezoids between the same two edges in neighbouring slabs are joined again, which leaves few.
class FormFactorSum {
 public:
  /// Both must outlive it. No texture: the colour is 1.
  FormFactorSum(const visibility::UnshadowedLight& seen, const std::optional<TextureBlocks>& texture)
      : seen_(seen), texture_(texture ? &*texture : nullptr) {}

  /// Slabs from left to right, and in each what lies between two edges: with their heights at the slab's ends. With a
  /// texture a slab lies within one column of blocks.
  void enter_slab(double from, double to);
  struct Side {
    const void* edge;  ///< only compared
    double from, to;
  };
  void add_between(const Side& low, const Side& high);
  /// After the last slab.
  void finish();

  /// A convex polygon of the light's plane, counter-clockwise, with up to four corners.
  void add_polygon(std::span<const glm::dvec2> corners);
  /// All of the light that is above the horizon; with a texture block by block.
  void add_whole();
  /// Complete after finish().
  [[nodiscard]] const glm::dvec3& sum() const { return sum_; }

 private:
  struct Part {
    const void *low, *high;
    Trapezoid shape;
  };

  void add(const Trapezoid& shape);
  void add_blocks(std::uint32_t column, std::span<const glm::dvec2> corners);
  void add_ended();
  [[nodiscard]] bool between_columns(double s) const;

  const visibility::UnshadowedLight& seen_;
  const TextureBlocks* texture_;
  double from_ = 0, to_ = 0;          // the slab
  std::vector<Part> before_, parts_;  // of the last slab what has not been continued; of this one
  glm::dvec3 sum_{0};
};

}  // namespace penumbra::areas
