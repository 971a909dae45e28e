// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/triangle_soup.hpp"
#include "volumes/wedges/penumbra_wedge.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

/// Wedges and hulls of lights as meshes for viewing.
namespace penumbra::volumes {

/// Convex polyhedron, its corners rounded to double.
struct WedgeBody {
  std::vector<glm::dvec3> corners;
  std::vector<mesh::Triangle> triangles;            ///< counter-clockwise seen from outside
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< where two faces meet, each once
};

/// Returns the part of a wedge in a box; without corners if the wedge has no planes or only touches the box, or if a
/// plane is not finite.
WedgeBody wedge_body(const Wedge& wedge, const Box& box);

/// Returns the corners of the convex polygon that a convex body has in the plane y = `height`, counter-clockwise seen
/// from +y; a face in this plane is such a polygon. Empty: the body has no area in the plane.
std::vector<glm::dvec3> section_at(const WedgeBody& body, double height);

/// Returns a flat hull as a fan, a solid hull as the polyhedron bounded by its faces; indices into its corners.
std::vector<mesh::Triangle> hull_triangles(const LightHull& light);

}  // namespace penumbra::volumes
