// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <span>

namespace penumbra::reference {

/// Lengths as passed to Embree: scene floats times a power of two that keeps Embree's products of three lengths within
/// float32, however small or large the scene. The scaling changes no answer, since all lengths scale.
///
/// Mesh and view samples are below 2¹⁴ and light points below 2⁶⁰: Embree accepts no numbers beyond 1.8 · 10¹⁸, and no
/// intermediate value of its robust test, at most 2³⁶ times the largest component of a direction, overflows. For a
/// triangle whose largest edge component is e and a ray of length R, the terms of sums are of the size e² R, and of e²
/// before they are multiplied with the ray; underflow loses at most 2⁻¹²⁶. That is less than a thirtieth of their
/// rounding error where e ≥ 2⁻⁵⁰ and e² R ≥ 2⁻⁹⁵. A direction to a sun is multiplied by a power of two that makes its
/// largest component 2¹³ to 2¹⁴.
class EmbreeRange {
 public:
  /// Throws InputError if a casting triangle is too small relative to the scene.
  EmbreeRange(const visibility::SceneFloats& scene, std::span<const std::uint32_t> casting);

  /// Throws InputError if the light's points are too far away for the size of the scene.
  void require_light(const visibility::Light& light, const visibility::Bounds& bounds) const;

  [[nodiscard]] glm::vec3 scaled(const glm::vec3& x) const { return glm::vec3(glm::dvec3(x) * scale_); }

  [[nodiscard]] double scale() const { return scale_; }

  /// Returns a direction scaled to about the size of the mesh, so that rays along it are never too short.
  [[nodiscard]] static glm::vec3 direction(const glm::vec3& d);

  /// Returns the length of the shortest ray that Embree can handle, measured by the largest component of its scaled
  /// direction.
  [[nodiscard]] float shortest_ray() const { return shortest_ray_; }

 private:
  double scale_ = 1;  ///< a power of two; it may exceed float's range
  float shortest_ray_ = 0;
};

}  // namespace penumbra::reference
