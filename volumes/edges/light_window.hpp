// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

/// A parallelogram of a light's plane that contains the light. Inside volumes/ only.
namespace penumbra::volumes {

/// The points centre + x u + y (v − shear u) with (x, y) from `low` to `high`, where centre, u and v are those of the
/// light's stored frame. So a place in the window is exact in the numbers that the light is stored with. A share is a
/// place in the window from (0, 0) to (1, 1).
struct LightWindow {
  double shear = 0;
  glm::dvec2 low{-1}, high{1};

  [[nodiscard]] glm::dvec2 size() const { return high - low; }
  /// Returns coordinates (s, t) of the frame, centre + s u + t v.
  [[nodiscard]] glm::dvec2 frame_place(const glm::dvec2& share) const {
    const glm::dvec2 at = low + share * size();
    return {at.x - shear * at.y, at.y};
  }
};

/// Returns the window. For a rectangle: the span of its own frame; for a round light: the span of the frame around it.
/// For a polygon: the rectangle around it along its frame's u, enlarged by 1/64 on each side, so that the outline is
/// strictly inside.
LightWindow window_of(const visibility::Light& light);

/// The window's axes in double, from the stored points; not scaled.
struct WindowAxes {
  glm::dvec3 corner{0}, u{0}, v{0};  ///< u and v run from the corner along the whole sides
  /// Condition of the frame relative to orthogonal axes: |u|₁ |v|₁ / |u × v| of the stored frame.
  double skew = 1;
};
WindowAxes axes_of(const visibility::Light& light, const LightWindow& window);

}  // namespace penumbra::volumes
