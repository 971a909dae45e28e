// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/light_basis.hpp"
#include "maps/host/map_method.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace penumbra::maps {

/// Returns `count` points spread evenly over a planar light, in its basis: always the same points. Every prefix of the
/// list is also spread evenly. (Unlike Light::points, the caller sets their number.)
std::vector<glm::vec2> light_pattern(const visibility::Light& light, const LightBasis& basis, std::uint32_t count);

/// Map from the unit square to a planar light that preserves ratios of areas and maps the square's outline to the
/// light's: squares around the middle become the light's own shape around the centroid (Shirley and Chiu 1997 for a
/// disk or ellipse; a rectangle is only scaled).
class LightSquare {
 public:
  explicit LightSquare(const visibility::Light& light);
  /// Returns the point in scene floats, the form of stored light samples.
  [[nodiscard]] glm::vec3 at(const glm::dvec2& unit) const;

 private:
  /// Returns the point of the outline at a fraction 0 ... 1 of the area swept around the centroid from the outline's
  /// start.
  [[nodiscard]] glm::dvec3 outline(double share) const;

  const visibility::Light* light_;
  visibility::LightFrame frame_;
  glm::dvec3 centroid_;
  std::vector<double> area_up_to_;  // of a polygon: area swept up to each corner, the last 1
};

/// Patterns of several counts (light_pattern), one after the other, on the device: points of the light for look-ups
/// that filter.
class LightPattern final : public MapProduct {
 public:
  LightPattern(const render::Device& device, std::initializer_list<std::uint32_t> counts);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return points_; }

 private:
  std::vector<std::uint32_t> counts_;
  render::Buffer points_;
};

/// Returns half the light's width: the radius of the disk of its area.
double half_width(const visibility::Light& light);

/// Returns the extent of the light from its centroid along the basis's u and v, on the farther side.
glm::dvec2 half_extent(const visibility::Light& light, const LightBasis& basis);

}  // namespace penumbra::maps
