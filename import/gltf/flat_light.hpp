#pragma once

#include "mesh/triangle_soup.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <variant>

namespace penumbra::scenes {

/// What an emissive mesh is as a light, or why it is none ("it is not flat").
using FlatLight = std::variant<Rectangle, Polygon, std::string>;

/// Recognises the area light whose body is the given triangles. They must lie in one plane, be wound alike, and cover
/// one convex outline, once: a rectangle if it has four corners, all right-angled, else a polygon. Both emit to the
/// side from which the triangles run counter-clockwise. `rounding` is how far each position may be from where its
/// author meant it to be: it alone decides what passes for flat, straight and right-angled.
FlatLight recognise_flat_light(std::span<const glm::dvec3> positions, std::span<const mesh::Triangle> triangles,
                               double rounding);

}  // namespace penumbra::scenes
