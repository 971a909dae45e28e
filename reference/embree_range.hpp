#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <span>

namespace penumbra::reference {

/// Lengths as Embree gets them: scene floats times a power of two that keeps its products of three lengths within
/// float32, however small or large the scene. Rays ask the same question at every scale, so no answer changes.
///
/// Mesh and view samples are below 2¹⁴ and light points below 2⁶⁰: Embree takes no numbers beyond 1.8 · 10¹⁸, and no
/// intermediate value of its robust test, at most 2³⁶ times the largest component of a direction, overflows. For a
/// triangle whose largest edge component is e and
/// a ray of length R, the terms that are added up are of the size e² R, and of e² before the ray comes in; what
/// underflows loses at most 2⁻¹²⁶. That is less than a thirtieth of their rounding error where e ≥ 2⁻⁵⁰ and
/// e² R ≥ 2⁻⁹⁵. A direction to a sun is multiplied by a power of two that makes its largest component 2¹³ to 2¹⁴.
class EmbreeRange {
 public:
  /// Throws InputError where a casting triangle is too small beside the scene.
  EmbreeRange(const visibility::SceneFloats& scene, std::span<const std::uint32_t> casting);

  /// Throws InputError if the light's points are too far away for the size of the scene.
  void require_light(const visibility::Light& light, const visibility::Bounds& bounds) const;

  [[nodiscard]] glm::vec3 scaled(const glm::vec3& x) const { return glm::vec3(glm::dvec3(x) * scale_); }

  [[nodiscard]] double scale() const { return scale_; }

  /// A direction, as long as the mesh is large: rays along it are never too short.
  [[nodiscard]] static glm::vec3 direction(const glm::vec3& d);

  /// The shortest ray, by the largest component of its scaled direction, that Embree can be asked about.
  [[nodiscard]] float shortest_ray() const { return shortest_ray_; }

 private:
  double scale_ = 1;  ///< a power of two; not every one that is needed is a float
  float shortest_ray_ = 0;
};

}  // namespace penumbra::reference
