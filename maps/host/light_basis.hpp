// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_view.shared.h"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace penumbra::maps {

/// Axes of a light's maps: orthonormal. For a planar light n points toward its emitting side, and u along its first
/// stored axis.
struct LightBasis {
  glm::dvec3 center{0};  ///< the light's centroid (a polygon's is not Light::center)
  glm::dvec3 u{0}, v{0}, n{0};

  /// Returns the coordinates of x in this basis.
  [[nodiscard]] glm::dvec3 local(const glm::dvec3& x) const;
  [[nodiscard]] gpu::LightBasis rounded() const { return {glm::vec3(u), glm::vec3(v), glm::vec3(n)}; }
};

/// Returns the basis of a planar light (no sphere).
LightBasis light_basis(const visibility::Light& light);
/// Returns the basis of any light. A sphere's basis has the world's axes; its n points toward the middle of the scene
/// along the axis on which the middle is farthest.
LightBasis light_basis(const visibility::Light& light, const visibility::SceneFloats& scene);

/// Bounding rectangle of the light along u and v; for a sphere, that of its disk.
struct LightBounds {
  glm::dvec2 lower{0}, upper{0};
};
LightBounds light_bounds(const visibility::Light& light, const LightBasis& basis);

/// The light's own axes (visibility::LightFrame) in the basis.
struct LightAxes {
  glm::dvec2 u{0}, v{0};
};
LightAxes light_axes(const visibility::Light& light, const LightBasis& basis);

/// Returns the corners of a rectangle or polygon in the basis; for an ellipse, those of a polygon of the same area, the
/// image of a regular polygon. (Error outside the ellipse: areas/light_region.hpp; with 256 sides, 2e-5 of the area.)
std::vector<glm::dvec2> light_outline(const visibility::Light& light, const LightBasis& basis);

}  // namespace penumbra::maps
