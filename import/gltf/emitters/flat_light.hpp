// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "import/gltf/emitters/welded.hpp"
#include "scenes/scene.hpp"

#include <glm/vec3.hpp>

#include <string>
#include <variant>
#include <vector>

namespace penumbra::import {

/// The light of an emissive mesh, or the reason why there is none ("it is not flat").
using FlatLight = std::variant<scenes::Rectangle, scenes::Polygon, std::string>;

/// Recognises the area light whose body is the given mesh. Its triangles must lie in one plane, have consistent
/// windings, and cover one convex outline once: a rectangle if it has four corners, all right-angled, else a polygon.
/// Both emit to the side from which the triangles run counter-clockwise. `rounding`, the distance of each position from
/// its intended place, alone decides what is flat, straight and right-angled.
FlatLight recognise_flat_light(const Welded& mesh, double rounding);

/// Returns the light whose outline runs through these corners, which must be flat and counter-clockwise as seen along
/// −`normal`; corners on a line between their neighbours are dropped.
FlatLight light_of_outline(std::vector<glm::dvec3> corners, const glm::dvec3& normal, double rounding);

}  // namespace penumbra::import
