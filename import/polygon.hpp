// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::import {

/// Method by which a polygon was triangulated.
enum class PolygonKind { convex, concave, tangled };

/// Appends to `triangles` the n − 2 triangles of the polygon with the corners `corners` (at least three), as indices
/// into `corners`, and returns the kind of triangulation:
/// - convex: the fan around corner 0, or cuts from side to side where straight corners would give the fan triangles
///   without area;
/// - concave: ear clipping, projected along the polygon's mean normal;
/// - tangled: ear clipping found no ear (the outline crosses itself or has no area), so the rest became a fan.
/// Gives n − 2 triangles with the polygon's winding for every input: nothing is dropped.
PolygonKind triangulate_polygon(std::span<const glm::dvec3> corners, std::vector<mesh::Triangle>& triangles);

}  // namespace penumbra::import
