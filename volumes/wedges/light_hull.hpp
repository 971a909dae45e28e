// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace penumbra::volumes {

/// Corners of a convex polygon or polyhedron that contains every point of a light, relative to the scene's origin.
/// Rectangles and polygons are their own stored corners. A disk becomes a circumscribed regular polygon, an ellipse an
/// affine image of one, a sphere a circumscribed polyhedron: these extend beyond the light by at most `slack`.
struct LightHull {
  std::vector<glm::dvec3> corners;
  glm::dvec3 center{0};
  double slack = 0;       ///< in the scene's unit
  bool is_solid = false;  ///< a polyhedron; otherwise a polygon, its corners in order
};

/// Returns the hull of `light`. `sides`: number of sides of a disk's polygon, which extends beyond the disk by radius ·
/// (1 / cos(π / sides) − 1), 0.5 % for 32.
LightHull light_hull(const visibility::Light& light, std::uint32_t sides = 32);

}  // namespace penumbra::volumes
