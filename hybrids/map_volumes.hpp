// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_fit.hpp"
#include "volumes/raster/light_volumes.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>

namespace penumbra::hybrids {

/// A shadow map seen from a light's centre: distances along the face's axis divided by `far`, row by row; 1 where
/// nothing is seen.
struct DepthMap {
  maps::Face face;
  std::span<const float> depths;
  std::uint32_t size = 0;  ///< on a side
  double far = 0;
  glm::vec3 light{0};
};

/// Adds the sides of the shadow volumes that a map shows: a wall between the depths of two neighbouring texels whose
/// surfaces are `jump` widths of a texel or more apart. No caps are added, since the surfaces themselves are the caps.
/// A wall is the side that begins at the nearer surface, minus the side that begins at the farther one.
void add_walls(const DepthMap& map, double jump, volumes::LightVolumes& volumes);

/// Returns whether the map shows a surface between its light and x.
bool is_behind(const DepthMap& map, const glm::dvec3& x);

}  // namespace penumbra::hybrids
