#pragma once

#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::mesh {

/// How a polygon became triangles.
enum class PolygonKind { convex, concave, tangled };

/// Appends to `triangles` the n − 2 triangles of the polygon with the corners `corners` (at least three), as indices
/// into `corners`, and says which way it took:
///  - convex: the fan around corner 0, or from side to side where corners in the middle of straight sides would leave
///  the
///    fan triangles without area;
///  - concave: ear clipping, seen along the polygon's mean normal;
///  - tangled: ear clipping found no more ear (the outline crosses itself or has no area), so the rest became a fan.
/// Always n − 2 triangles with the polygon's winding, whatever the input: nothing is dropped.
PolygonKind triangulate_polygon(std::span<const glm::dvec3> corners, std::vector<Triangle>& triangles);

}  // namespace penumbra::mesh
