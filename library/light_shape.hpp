#pragma once

#include "scenes/scene.hpp"

#include <penumbra/scene.hpp>

#include <glm/vec3.hpp>

#include <optional>

/// The interface's vectors and shapes of lights as the rooms have them, and back.
namespace penumbra {

inline glm::dvec3 to_glm(const Vector& v) {
  return {v[0], v[1], v[2]};
}
inline Vector from_glm(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// Throws InputError for a direction without length.
scenes::LightShape to_scene(const LightShape& shape);
/// Nullopt for a light in pieces, which the interface has no shape for.
std::optional<LightShape> from_scene(const scenes::LightShape& shape);

}  // namespace penumbra
