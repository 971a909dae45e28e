#pragma once

#include "import/gltf/emitters/welded.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <string>
#include <variant>
#include <vector>

namespace penumbra::scenes {

/// What an emissive mesh is as a light, or why it is none ("it is not flat").
using FlatLight = std::variant<Rectangle, Polygon, std::string>;

/// Recognises the area light whose body is the given mesh. Its triangles must lie in one plane, be wound alike, and
/// cover one convex outline, once: a rectangle if it has four corners, all right-angled, else a polygon. Both emit to
/// the side from which the triangles run counter-clockwise. `rounding` is how far each position may be from where its
/// author meant it to be: it alone decides what passes for flat, straight and right-angled.
FlatLight recognise_flat_light(const Welded& mesh, double rounding);

/// The light whose outline runs through these corners, flat and counter-clockwise seen along −`normal`; corners on a
/// line between their neighbours are dropped.
FlatLight light_of_outline(std::vector<glm::dvec3> corners, const glm::dvec3& normal, double rounding);

}  // namespace penumbra::scenes
