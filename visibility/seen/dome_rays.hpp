// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/seen/placed_meshes.hpp"
#include "visibility/seen/triangle_bits.hpp"
#include "visibility/seen/view_rays.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// Finds blockers between points and the light samples of a dome. A shaft to a dome would hold everything; but whether
/// one of its directions is blocked is decided by any single triangle that blocks it.
class DomeRays {
 public:
  /// All arguments must outlive this object. `dome`: with its light samples.
  DomeRays(const PlacedMeshes& meshes, const Light& dome);

  /// Sets the bits of triangles such that each pair of a point and a light sample has the answer that all triangles
  /// give: one opaque triangle that blocks the pair beyond doubt, or else all triangles that may be in between, opaque
  /// and translucent.
  void add(std::span<const SeenPoint> points, TriangleBits& seen) const;

 private:
  class Walk;
  /// Effect of an object's triangles on this light.
  enum class Role : std::uint8_t { none, blocks, filters };

  const PlacedMeshes& meshes_;
  const Light& dome_;
  std::vector<Role> roles_;  // for each object
};

}  // namespace penumbra::visibility
