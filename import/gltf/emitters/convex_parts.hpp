#pragma once

#include "import/gltf/emitters/welded.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra::scenes {

/// A flat convex part of a mesh.
struct ConvexPart {
  std::vector<std::uint32_t> outline;  ///< points, counter-clockwise seen from the front
  glm::dvec3 normal{0};                ///< unit
};

/// A mesh in flat convex parts, few of them: triangles joined across common edges, longest first, as long as what comes
/// of it is flat and convex (Hertel and Mehlhorn, "Fast triangulation of simple polygons", 1983, section 3, where any
/// order gives at most four times the fewest). Each triangle is in one part. What passes for flat and convex is decided
/// by `rounding` alone: how far each point may be from where its author meant it to be. Triangles whose height is
/// within that have no side that they face, and are left out.
std::vector<ConvexPart> convex_parts(const Welded& mesh, double rounding);

/// Its triangles (numbers) in regions: across an edge from triangle to triangle, as long as the two are flat together.
/// Many such steps may bend: a region need not be flat.
std::vector<std::vector<std::size_t>> flat_regions(const Welded& mesh, double rounding);

}  // namespace penumbra::scenes
