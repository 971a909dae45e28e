// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <limits>

namespace penumbra::maps {

/// Axes of a face of a hemicube, as in taps.glsl. A window has the axes of the first face.
struct BaseFace {
  int axis;
  double sign;

  [[nodiscard]] glm::dmat3 matrix() const {  // maps a direction e = (x, y, |z|) to the face's (a, b, w)
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const glm::dmat3 rows = axis == 2   ? glm::dmat3(x, y, z)
                            : axis == 0 ? glm::dmat3(y, z, sign * x)
                                        : glm::dmat3(x, z, sign * y);
    return glm::transpose(rows);
  }
  [[nodiscard]] glm::dvec3 along() const {
    glm::dvec3 unit(0);
    unit[axis] = sign;
    return unit;
  }
};
inline constexpr std::array<BaseFace, 5> kHemicube{{{2, 1}, {0, 1}, {0, -1}, {1, 1}, {1, -1}}};

struct PlaceBounds {
  glm::dvec2 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec2& at) {
    lower = glm::min(lower, at);
    upper = glm::max(upper, at);
  }
};

/// Returns the matrix that maps homogeneous positions (a' k, b' k, k) in `bounds` to the range 0 to 1, with the
/// fraction `margin` of the face left free on every side.
inline glm::dmat3 to_unit(PlaceBounds bounds, double margin) {
  // A body seen edge-on has zero width: then float32's resolution of a tangent is used.
  const glm::dvec2 least = 0x1p-20 * (1.0 + glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper)));
  const glm::dvec2 middle = 0.5 * (bounds.lower + bounds.upper);
  const glm::dvec2 half = glm::max(0.5 * (bounds.upper - bounds.lower), least) / (1 - 2 * margin);
  const glm::dvec2 scale = 0.5 / half, shift = glm::dvec2(0.5) - scale * middle;
  return {{scale.x, 0, 0}, {0, scale.y, 0}, {shift.x, shift.y, 1}};
}

}  // namespace penumbra::maps
