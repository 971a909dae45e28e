// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "areas/back_projection.hpp"

#include <glm/vec3.hpp>

#include <array>

// Planes of BackProjection in double, with their error bounds; sufficient for points that are not near any of these
// planes, which are most points. Internal to areas/.

namespace penumbra::areas {

/// The pyramid from p to a box on the light's plane, as planes whose heights have error bounds: answers "certainly
/// inside", "certainly outside", or neither.
class LightShaft {
 public:
  /// Clip planes that a point is certainly strictly inside of, and planes that it is certainly outside of (bits); among
  /// the latter kBehind: not on the light's side of p.
  struct Sides {
    unsigned inside = 0, outside = 0;
  };
  static constexpr unsigned kBehind = 1u << kClipPlanes;

  /// `mirrored`: BackProjection::mirrored(), whether p is behind the light's plane.
  LightShaft(const IntegerFrame& frame, bool mirrored, const glm::vec3& p, const GridBox& box);

  [[nodiscard]] Sides sides_of(const glm::vec3& q) const;
  /// Returns whether the box is certainly outside of one of the planes.
  [[nodiscard]] bool misses(const glm::vec3& lower, const glm::vec3& upper) const;

 private:
  /// Plane with height(q) = constant + normal · (q − p), off by no more than 2^-48 (constant_size + Σ size |q − p|).
  struct Plane {
    glm::dvec3 normal{0}, size{0};
    double constant = 0, constant_size = 0;
  };

  glm::dvec3 p_;
  std::array<Plane, kClipPlanes + 1> planes_;
};

}  // namespace penumbra::areas
