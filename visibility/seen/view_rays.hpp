// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/seen/placed_meshes.hpp"
#include "visibility/view_samples.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra::visibility {

/// A point at which lights may be evaluated.
struct SeenPoint {
  glm::vec3 p{0}, n{0};              ///< scene floats; the surface's normal toward the viewer, of any length
  std::array<glm::vec3, 3> carrier;  ///< corners of the surface
};

/// Finds what pixels see of placed meshes: along each ray, the nearest opaque triangle, and the translucent ones in
/// front of it.
class ViewRays {
 public:
  /// All arguments must outlive this object.
  ViewRays(const PlacedMeshes& meshes, const PinholeCamera& camera);

  /// Appends the bits of the triangles that the pixel sees, and the points seen.
  void look(std::uint32_t x, std::uint32_t y, std::vector<std::uint64_t>& bits, std::vector<SeenPoint>& points) const;

 private:
  struct Met {
    double t;
    std::uint64_t bit;
    std::array<glm::vec3, 3> corners;
  };
  class Walk;

  const PlacedMeshes& meshes_;
  const PinholeCamera& camera_;
  std::vector<std::uint8_t> is_solid_;  // for each object
};

}  // namespace penumbra::visibility
