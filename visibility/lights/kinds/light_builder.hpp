#pragma once

#include "base/error.hpp"
#include "visibility/light_samples.hpp"

#include <string>
#include <vector>

namespace penumbra::visibility {

/// What is thrown for a light without an area. Of a light in pieces such a piece is left out; any other light is
/// refused.
struct NoArea : InputError {
  using InputError::InputError;
};

/// A light while it is made: world space in double, minus the origin, is rounded once to float32. Inside visibility/
/// only.
struct LightBuilder {
  Light& light;
  const glm::dvec3& origin;
  const std::vector<glm::dvec2>& unit;       ///< the light samples on the unit square
  const scenes::Texture* picture = nullptr;  ///< of the sky

  [[nodiscard]] glm::vec3 stored(const glm::dvec3& world) const;
  [[noreturn]] void refuse_zero_area(const std::string& detail) const;

  /// The frame must span a plane after rounding too, and emit to the side it was meant to. A frame that is not finite
  /// is stored as it is: make_light refuses it.
  void store_frame(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const;
  void add_sample(const glm::dvec2& coordinate, const glm::dvec3& world) const;
  /// The frame's parallelogram as outline.
  void store_outline(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const;
  /// The unit disk of a frame: frame, outline and samples.
  void add_round(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v) const;
};

bool is_finite_point(const glm::vec3& v);

/// Unit square to unit disk, areas in proportion: Shirley, Chiu, "A low distortion map between disk and square" (1997).
glm::dvec2 concentric_disk(const glm::dvec2& unit);

}  // namespace penumbra::visibility
