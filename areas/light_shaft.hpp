#pragma once

#include "areas/back_projection.hpp"

#include <glm/vec3.hpp>

#include <array>

// Inside areas/ only: the same planes as BackProjection's in double, with their error bounds; for what is not near
// any of them, which is most.

namespace penumbra::areas {

class LightShaft {
 public:
  /// Which clip planes a point is certainly strictly inside of, and which ones it is certainly outside of (bits); among
  /// the latter kBehind: not on the light's side of p.
  struct Sides {
    unsigned inside = 0, outside = 0;
  };
  static constexpr unsigned kBehind = 1u << kClipPlanes;

  /// `mirrored` as the exact projection has it: which way p is off the light's plane.
  LightShaft(const IntegerFrame& frame, bool mirrored, const glm::vec3& p, const GridBox& box);

  [[nodiscard]] Sides sides_of(const glm::vec3& q) const;
  /// Is the box certainly outside of one of the planes?
  [[nodiscard]] bool misses(const glm::vec3& lower, const glm::vec3& upper) const;

 private:
  /// height(q) = constant + normal · (q − p), off by no more than 2^-48 (constant_size + Σ size |q − p|).
  struct Plane {
    glm::dvec3 normal{0}, size{0};
    double constant = 0, constant_size = 0;
  };

  glm::dvec3 p_;
  std::array<Plane, kClipPlanes + 1> planes_;
};

}  // namespace penumbra::areas
