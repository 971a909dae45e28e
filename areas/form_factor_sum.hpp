// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_texture.hpp"
#include "visibility/lights/unshadowed_light.hpp"
#include "visibility/skies/sky_part.hpp"

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

// Form factors of the uncovered parts of sweeps: the sweep in areas/, and the one in volumes/scatter/.

namespace penumbra::areas {

/// Trapezoid of the light's plane with sides along t: at s0 from low0 to high0, at s1 from low1 to high1.
struct Trapezoid {
  double s0, s1, low0, low1, high0, high1;
};

/// Texture in the form used by form factors, where every texel costs a polygon: texels, or for a texture with more than
/// kMost on a side the means of blocks of texels (the last column and row of blocks may be narrower).
class TextureBlocks {
 public:
  static constexpr std::uint32_t kMost = 64;

  explicit TextureBlocks(const visibility::LightTexture& texture);

  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  /// Returns the left border of column x; the same number as the sweep's break there.
  [[nodiscard]] double left(std::uint32_t x) const { return 2.0 * std::min(x * across_, width_) / width_ - 1; }
  /// Returns the upper border of row y, from the top, t = 1, downward.
  [[nodiscard]] double top(std::uint32_t y) const { return 1 - 2.0 * std::min(y * down_, height_) / height_; }
  [[nodiscard]] std::uint32_t column_at(double s) const;
  [[nodiscard]] std::uint32_t row_at(double t) const;
  [[nodiscard]] const glm::dvec3& color(std::uint32_t x, std::uint32_t y) const {
    return colors_[std::size_t{y} * columns_ + x];
  }

 private:
  std::uint32_t width_, height_;  // in texels
  std::uint32_t across_, down_;   // in texels, of a block
  std::uint32_t columns_, rows_;  // of blocks
  std::vector<glm::dvec3> colors_;
};

/// Adds form factors of parts of a light, times the colours of the parts (a texture's, or a sky's). The sweep cuts its
/// slabs wherever any edge ends; trapezoids between the same two edges in neighbouring slabs are joined again, which
/// leaves few.
class FormFactorSum {
 public:
  /// Both arguments must outlive this object. Without a texture the colour is 1.
  FormFactorSum(const visibility::UnshadowedLight& seen, const std::optional<TextureBlocks>& texture)
      : seen_(seen), texture_(texture ? &*texture : nullptr) {
    if (seen.light().dome && seen.light().dome->sky) sky_.emplace(seen.light());
  }

  /// Begins the next slab, from left to right; add_between then adds the parts between two edges, with the edges'
  /// heights at the slab's ends. With a texture a slab lies within one column of blocks.
  void enter_slab(double from, double to);
  struct Side {
    const void* edge;  ///< used for comparison only
    double from, to;
  };
  void add_between(const Side& low, const Side& high);
  /// Ends the sum; to be called after the last slab.
  void finish();

  /// Adds a convex polygon of the light's plane, counter-clockwise, with up to four corners.
  void add_polygon(std::span<const glm::dvec2> corners);
  /// Adds all of the light above the horizon; with a texture block by block.
  void add_whole();
  /// Returns the sum; complete after finish().
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
  std::optional<visibility::SkyPart> sky_;  // for a face of a dome with a picture
  double from_ = 0, to_ = 0;                // the slab
  std::vector<Part> before_, parts_;        // parts of the last slab that have not been continued; parts of this slab
  glm::dvec3 sum_{0};
};

}  // namespace penumbra::areas
