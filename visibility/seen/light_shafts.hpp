#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/seen/box_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::visibility {

/// Places between which ways go: corners whose hull has all of a light's points, or directions to them.
struct LightHull {
  bool directions = false;  ///< `corners` are directions, of ways without end
  std::vector<glm::dvec3> corners;
  bool in_order = false;  ///< corners go around the light
  /// Where ways end on one side of a plane alone: its normal, on that side, and a point of it.
  struct Front {
    glm::dvec3 normal, at;
  };
  std::optional<Front> front = {};
  double room = 0;  ///< what light points may be beside it
};
/// Of the pieces of one light, which are no domes.
LightHull hull_of(std::span<const Light> pieces);

/// All ways from the points of a box to a light: the planes that bound these and the light's corners as seen along each
/// axis (Haines and Wallace 1991), and those that run along the sides of the light. Errs by what is near and on no way.
class LightShaft {
 public:
  /// `reach`: no way of a direction is followed farther, along any axis.
  LightShaft(const glm::dvec3& lower, const glm::dvec3& upper, const LightHull& light, double reach);

  [[nodiscard]] bool touches(const MiddleBox& box) const;
  [[nodiscard]] bool touches(const std::array<glm::vec3, 3>& triangle) const;

 private:
  /// Nothing of the shaft is beyond normal · x = most.
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
