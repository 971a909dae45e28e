// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/pairs/light_box.hpp"
#include "engines/pairs/light_pixels.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::vsm {

/// View samples on a plane, or on a height field over one, in a grid of texels; and triangles' footprints there: the
/// box, along the grid, around the projections of a triangle's corners from the light's corners (Eisemann and Décoret
/// 2007, section 4.1). Over a height field, the box contains the projections onto its lowest and its highest plane. At
/// height h, the line from l through x is at l + (x − l) (H_l − h) / (H_l − h_x). This is linear in h; for either
/// plane's h, it is projective in x and in l, so corners bound it.
class PlanarReceiver {
 public:
  /// `normal`: approximate normal of the plane, on the light's side. `reach`: at least the length of all positions.
  PlanarReceiver(const pairs::LightBox& light, const glm::dvec3& normal, double reach,
                 std::vector<std::uint32_t> pixels, std::span<const glm::vec3> p, double per_texel);

  [[nodiscard]] std::uint32_t pixel(std::uint32_t number) const { return pixels_[number]; }
  /// Returns the depth of each view sample below 0: a triangle hides only deeper ones.
  [[nodiscard]] std::span<const double> depths() const& { return depths_; }
  std::span<const double> depths() const&& = delete;
  [[nodiscard]] pairs::LightPixels& texels() { return texels_; }

  /// Returns the triangle's footprint. If it has no points and is not `everywhere`, the triangle hides nothing from any
  /// view sample.
  [[nodiscard]] pairs::Footprint footprint(const std::array<glm::vec3, 3>& corners) const;
  [[nodiscard]] double nearest(const std::array<glm::vec3, 3>& corners) const;

 private:
  [[nodiscard]] glm::dvec3 place(const glm::dvec3& x) const;

  glm::dvec3 across_{0}, along_{0}, normal_{0};
  bool sun_ = false;
  std::array<glm::dvec3, 4> light_{};  ///< the light's corners, for a sun directions: coordinates along the plane, and
                                       ///< height over it
  double error_ = 0;                   ///< error of a place
  double lowest_ = 0, highest_ = 0;    ///< heights of its view samples
  double light_low_ = 0, light_high_ = 0;
  std::vector<std::uint32_t> pixels_;
  std::vector<double> depths_;
  pairs::LightPixels texels_;
};

}  // namespace penumbra::vsm
