#pragma once

#include "mesh/triangle_soup.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <optional>
#include <span>

namespace penumbra::scenes {

/// Recognises the sphere that the given triangles approximate: their corners lie on it (`rounding` is how far each may
/// be from where its author meant it to be), they close around its centre once, facing outward, and none comes nearer
/// to the centre than 0.9 of its radius (an icosphere of 80 faces: 0.92; a cube, whose corners lie on a sphere too:
/// 0.58). What comes back has the triangles' surface area, so that it emits the same power: 4 π r² = Σ areas.
std::optional<Sphere> recognise_sphere(std::span<const glm::dvec3> positions, std::span<const mesh::Triangle> triangles,
                                       double rounding);

}  // namespace penumbra::scenes
