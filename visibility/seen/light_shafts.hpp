#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/seen/box_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
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
/// Returns the hull of the pieces of one light, which are no domes.
LightHull hull_of(std::span<const Light> pieces);

/// All segments from the points of a box to a light: bounded by the planes around the box and the light's corners as
/// seen along each axis (Haines and Wallace 1991), and by planes along the sides of the light. Conservative: also holds
/// surfaces that are near, and on no segment.
class LightShaft {
 public:
  /// `reach`: length along any axis up to which rays of directions are followed.
  LightShaft(const glm::dvec3& lower, const glm::dvec3& upper, const LightHull& light, double reach);

  [[nodiscard]] bool touches(const MiddleBox& box) const;
  [[nodiscard]] bool touches(const std::array<glm::vec3, 3>& triangle) const;

 private:
  /// The shaft has no point with normal · x > most.
  struct Plane {
    glm::dvec3 normal{0};
    double most = 0;
  };
  void add_planes_along(int axis);
  void add_plane(const glm::dvec3& normal);
  [[nodiscard]] bool is_around(const MiddleBox& box) const;

  MiddleBox around_;
  double room_;
  std::vector<glm::dvec3> corners_;
  std::vector<Plane> planes_;
};

}  // namespace penumbra::visibility
