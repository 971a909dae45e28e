// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>

namespace penumbra::pairs {

/// A planar light, or a sun, in its own axes, which are orthonormal up to rounding.
///
/// Planar: x = origin + a across + b along + h axis; light samples have (a, b) in [lower, upper] and |h| ≤ off. Sun: a
/// light sample is the direction −axis + a across + b along, of any length, (a, b) in [lower, upper], and `off` is the
/// largest error of such a direction. (0, 0) is in [lower, upper], too.
struct LightBox {
  bool sun = false;
  glm::dvec3 origin{0};                     ///< the light's stored centre; 0 for a sun
  glm::dvec3 across{0}, along{0}, axis{0};  ///< axis: the emitting side of the front; for a sun, the direction in which
                                            ///< light travels
  glm::dvec2 lower{0}, upper{0};
  double off = 0;

  /// Returns the point (for a sun: the direction) of the light at (a, b).
  [[nodiscard]] glm::dvec3 at(const glm::dvec2& ab) const {
    return origin - (sun ? axis : glm::dvec3(0)) + ab.x * across + ab.y * along;
  }
  [[nodiscard]] std::array<glm::dvec2, 4> corners() const {
    return {lower, glm::dvec2(upper.x, lower.y), upper, glm::dvec2(lower.x, upper.y)};
  }
  /// Returns (a, b, h) of a point; for a sun, whose origin is 0, h grows in the direction in which light travels.
  [[nodiscard]] glm::dvec3 place(const glm::dvec3& x) const {
    const glm::dvec3 d = x - origin;
    return {dot3(across, d), dot3(along, d), dot3(axis, d)};
  }
  /// Returns (a, b) of a light sample.
  [[nodiscard]] glm::dvec2 sample(const glm::vec3& l) const;

 private:
  static double dot3(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
};

/// Makes the box of a light other than a sphere. Throws InputError for a sun nearly as wide as a half-space.
LightBox make_light_box(const visibility::Light& light);

}  // namespace penumbra::pairs
