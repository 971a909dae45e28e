// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <penumbra/scene.hpp>

#include <glm/vec3.hpp>

#include <optional>

/// Conversions between the public interface's vectors and shapes of lights and those of scenes/.
namespace penumbra {

inline glm::dvec3 to_glm(const Vector& v) {
  return {v[0], v[1], v[2]};
}
inline Vector from_glm(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// Returns the shape in the form of scenes/. Throws InputError for a direction of length 0.
scenes::LightShape to_scene(const LightShape& shape);
/// Returns the interface's shape; nullopt for a light in pieces, for which the interface has no shape.
std::optional<LightShape> from_scene(const scenes::LightShape& shape);

}  // namespace penumbra
