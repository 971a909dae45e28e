// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/pairs/light_box.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>

namespace penumbra::vsm {

/// A box in a LightBox's axes: (a, b, h).
struct PlaceBox {
  glm::dvec3 lower{0}, upper{0};
};

/// Bounds of the space between a light and view samples, in the light's axes. At the fraction s from a light point l to
/// p, the segment is at l + s (p − l). Since h is 0 at the light, h determines s: a box between two heights can be met
/// only at the s between these heights. A sun's ray with slope σ is at p + (h_p − h) σ. Bounds are rounded outward.
class LightShaft {
 public:
  LightShaft() = default;
  /// `reach`: at least the length of all positions.
  LightShaft(const pairs::LightBox& light, double reach);

  /// Returns a box around points, rounded outward.
  template <typename Points>
  [[nodiscard]] PlaceBox box_of(const Points& points) const;
  /// Returns whether some segment from `receivers` to the light samples in [lower, upper] may meet the box `triangle`.
  [[nodiscard]] bool meets(const PlaceBox& receivers, const PlaceBox& triangle, const glm::dvec2& lower,
                           const glm::dvec2& upper) const;

 private:
  [[nodiscard]] bool sun_meets(const PlaceBox& receivers, const PlaceBox& triangle, const glm::dvec2& lower,
                               const glm::dvec2& upper) const;

  pairs::LightBox light_;
  double margin_ = 0;
};

template <typename Points>
PlaceBox LightShaft::box_of(const Points& points) const {
  PlaceBox box{light_.place(glm::dvec3(points[0])), {}};
  box.upper = box.lower;
  for (const auto& point : points) {
    const glm::dvec3 place = light_.place(glm::dvec3(point));
    for (int i = 0; i < 3; ++i) {
      box.lower[i] = place[i] < box.lower[i] ? place[i] : box.lower[i];
      box.upper[i] = place[i] > box.upper[i] ? place[i] : box.upper[i];
    }
  }
  box.lower -= margin_;
  box.upper += margin_;
  return box;
}

}  // namespace penumbra::vsm
