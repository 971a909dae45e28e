// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <variant>

namespace penumbra::import {

/// An emissive mesh as a light.
struct Emitter {
  scenes::LightShape shape;
  bool two_sided = false;
  /// True if a part of the mesh lies in front of another that emits toward it. A light's own mesh hides none of its
  /// light here, so the light emits more than a real emitter of this shape.
  bool hides_itself = false;
};

/// Reason, for messages, why an emitter that hides parts of itself cannot be a light.
inline constexpr const char* kHidesItself =
    "is an emitter with parts that shadow one another; a light's own mesh casts no shadow of it, so it would be too "
    "bright (make its parts separate objects)";

/// Meshes with more pieces are refused: each piece costs as much as a light.
inline constexpr std::size_t kMostPieces = 1024;

/// Returns the light whose body is the given triangles, or the reason why there is none. The whole mesh may be a flat
/// convex outline (flat_light.hpp) or a sphere (sphere_light.hpp). Otherwise each of its connected meshes is one of
/// these, or is divided into flat convex parts (convex_parts.hpp).
///
/// Triangles emit to the side from which they run counter-clockwise, or to both sides if `two_sided`. But only the
/// outside of a closed mesh is visible, and a mesh enclosed by another is invisible: if `two_sided`, closed meshes emit
/// outward regardless of their winding, and meshes inside a closed mesh that emits outward do not emit. `rounding`:
/// distance of each position from its intended place.
std::variant<Emitter, std::string> recognise_emitter(std::span<const glm::dvec3> positions,
                                                     std::span<const mesh::Triangle> triangles, bool two_sided,
                                                     double rounding);

}  // namespace penumbra::import
