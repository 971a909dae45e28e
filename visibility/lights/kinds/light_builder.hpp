// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"
#include "visibility/light_samples.hpp"

#include <string>
#include <vector>

namespace penumbra::visibility {

/// Thrown for a light without an area. A piece without area is left out of a light in pieces; any other light is
/// refused.
struct NoArea : InputError {
  using InputError::InputError;
};

/// A light under construction: world space in double, minus the origin, is rounded once to float32. Inside visibility/
/// only.
struct LightBuilder {
  Light& light;
  const glm::dvec3& origin;
  const std::vector<glm::dvec2>& unit;       ///< the light samples on the unit square
  const scenes::Texture* picture = nullptr;  ///< picture of the sky

  [[nodiscard]] glm::vec3 stored(const glm::dvec3& world) const;
  [[noreturn]] void refuse_zero_area(const std::string& detail) const;

  /// Stores the frame, which must span a plane also after rounding, and emit to the intended side. A frame that is not
  /// finite is stored unchanged: make_light refuses it.
  void store_frame(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const;
  void add_sample(const glm::dvec2& coordinate, const glm::dvec3& world) const;
  /// Stores the frame's parallelogram as outline.
  void store_outline(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const;
  /// Adds the unit disk of a frame: frame, outline and samples.
  void add_round(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const;
};

bool is_finite_point(const glm::vec3& v);

/// Maps the unit square to the unit disk, areas in proportion: Shirley, Chiu, "A low distortion map between disk and
/// square" (1997).
glm::dvec2 concentric_disk(const glm::dvec2& unit);

}  // namespace penumbra::visibility
