#pragma once

#include "visibility/light_samples.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>

namespace penumbra::pairs {

/// A planar light, or a sun, in axes of its own. Axes are unit vectors at right angles, up to rounding.
///
/// Planar: x = origin + a across + b along + h axis; light samples have (a, b) in [lower, upper] and |h| ≤ off. Sun:
/// a light sample is the direction −axis + a across + b along, of whatever length, (a, b) in [lower, upper], `off` what
/// such a direction is off by at most. (0, 0) is in [lower, upper], too.
struct LightBox {
  bool sun = false;
  glm::dvec3 origin{0};                     ///< the light's stored centre; of a sun 0
  glm::dvec3 across{0}, along{0}, axis{0};  ///< axis: where the front emits to; of a sun, the way that light travels
  glm::dvec2 lower{0}, upper{0};
  double off = 0;

  /// The points (sun: directions) of the light at (a, b).
  [[nodiscard]] glm::dvec3 at(const glm::dvec2& ab) const {
    return origin - (sun ? axis : glm::dvec3(0)) + ab.x * across + ab.y * along;
  }
  [[nodiscard]] std::array<glm::dvec2, 4> corners() const {
    return {lower, glm::dvec2(upper.x, lower.y), upper, glm::dvec2(lower.x, upper.y)};
  }
  /// (a, b, h) of a point; of a sun, whose origin is 0, h grows the way that light travels.
  [[nodiscard]] glm::dvec3 place(const glm::dvec3& x) const {
    const glm::dvec3 d = x - origin;
    return {dot3(across, d), dot3(along, d), dot3(axis, d)};
  }
  /// Of a light sample: (a, b).
  [[nodiscard]] glm::dvec2 sample(const glm::vec3& l) const;

 private:
  static double dot3(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
};

/// Not of a sphere. Throws InputError for a sun that is all but a half-space wide.
LightBox make_light_box(const visibility::Light& light);

}  // namespace penumbra::pairs
