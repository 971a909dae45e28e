#pragma once

#include "maps/host/light_basis.hpp"
#include "maps/host/map_method.hpp"
#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace penumbra::maps {

/// `count` points spread evenly over a planar light, in its basis: always the same ones. Any first part of them is
/// spread evenly too. (Unlike Light::points their number is the caller's.)
std::vector<glm::vec2> light_pattern(const visibility::Light& light, const LightBasis& basis, std::uint32_t count);

/// The unit square laid onto a planar light, areas in proportion, its outline on the light's: squares around its middle
/// become the light's own shape around the centroid (Shirley and Chiu 1997 for a disk or ellipse; a rectangle as it
/// is).
class LightSquare {
 public:
  explicit LightSquare(const visibility::Light& light);
  /// In scene floats, as light samples are stored.
  [[nodiscard]] glm::vec3 at(const glm::dvec2& unit) const;

 private:
  /// The outline, a share of the area swept around the centroid from its start, 0 ... 1.
  [[nodiscard]] glm::dvec3 outline(double share) const;

  const visibility::Light* light_;
  visibility::LightFrame frame_;
  glm::dvec3 centroid_;
  std::vector<double> area_up_to_;  // of a polygon: swept up to each corner, the last 1
};

/// light_pattern of several counts, one behind the other, on the device: what look-ups that filter need of the light.
class LightPattern final : public MapProduct {
 public:
  LightPattern(const render::Device& device, std::initializer_list<std::uint32_t> counts);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return points_; }

 private:
  std::vector<std::uint32_t> counts_;
  render::Buffer points_;
};

/// Half the light's width: the radius of the disk of its area.
double half_width(const visibility::Light& light);

/// How far the light reaches from its centroid along the basis's u and v, on the farther side.
glm::dvec2 half_extent(const visibility::Light& light, const LightBasis& basis);

}  // namespace penumbra::maps
