// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/seen/box_tree.hpp"
#include "visibility/seen/placed_meshes.hpp"
#include "visibility/seen/shaft_planes.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// End points of segments to a light: corners whose hull has all of a light's points, or directions to them.
struct LightHull {
  bool directions = false;  ///< `corners` are directions of rays without end
  std::vector<glm::dvec3> corners;
  bool in_order = false;  ///< corners are in order around the light
  /// For a light that emits to one side of a plane: the plane's normal, to that side, and a point of the plane.
  struct Front {
    glm::dvec3 normal, at;
  };
  std::optional<Front> front = {};
  double room = 0;  ///< distance by which light points may be outside the hull
};
/// Returns the hull of the pieces of one light. Not for domes.
LightHull hull_of(std::span<const Light> pieces);

/// All segments from the points of a box to a light: bounded by the planes around the box and the light's corners as
/// seen along each axis (Haines and Wallace 1991), and by planes along the sides of the light. Conservative: it may
/// contain nearby surfaces that no segment meets.
class LightShaft {
 public:
  /// `reach`: length along any axis up to which rays of directions are followed.
  LightShaft(const glm::dvec3& lower, const glm::dvec3& upper, const LightHull& light, double reach);

  /// The shaft has no point with normal · x > most.
  struct Plane {
    glm::dvec3 normal;
    double most;
  };

  [[nodiscard]] bool touches(const MiddleBox& box) const;
  /// Calls take(plane) for each plane of the shaft, the sides of the box around it among them.
  template <typename Take>
  void for_each_plane(const Take& take) const;

 private:
  void add_planes_along(int axis);
  void add_plane(const glm::dvec3& normal);
  [[nodiscard]] bool is_around(const MiddleBox& box) const;

  MiddleBox around_;
  double room_;
  std::vector<glm::dvec3> corners_;
  std::vector<Plane> planes_;
};

template <typename Take>
void LightShaft::for_each_plane(const Take& take) const {
  for (const Plane& plane : planes_) take(plane);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 normal(0);
    normal[axis] = 1;
    take({normal, around_.middle[axis] + around_.half[axis]});
    take({-normal, around_.half[axis] - around_.middle[axis]});
  }
}

/// A shaft in the space of one part of the placed meshes, for that part's boxes and triangles.
class ShaftOfPart {
 public:
  ShaftOfPart(const LightShaft& shaft, const PlacedMeshes::Part& part);

  /// Calls take(triangle) for the part's triangles that may reach into the shaft.
  template <typename Take>
  void walk(const Take& take) const {
    if (misses_) return;
    thread_local std::vector<std::uint32_t> triangles;
    triangles.clear();
    touched(*part_.tree, *part_.soup, planes_, triangles);
    for (const std::uint32_t triangle : triangles) take(triangle);
  }

 private:
  const PlacedMeshes::Part& part_;
  ShaftPlanes planes_;
  bool misses_ = false;  // the part is outside of the shaft
};

}  // namespace penumbra::visibility
