// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/wedge_plane.hpp"

#include <glm/vec3.hpp>
#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// A wedge cut by a box, as a polyhedron whose corners are exact rationals. Internal to this room, since it uses
/// GMP's types.
namespace penumbra::volumes {

struct ExactPoint {
  std::array<mpq_class, 3> at;
  glm::dvec3 near{0};  ///< each coordinate within 2⁻⁵² of the exact one

  ExactPoint() = default;
  explicit ExactPoint(const glm::dvec3& p);
  explicit ExactPoint(std::array<mpq_class, 3> exact);
};

/// Returns a x + b y + c z + d, exactly.
mpq_class height_of(const Plane& plane, const ExactPoint& p);
/// Returns the sign of height_of(plane, p): computed in double where the result is certain.
int side_of(const Plane& plane, const ExactPoint& p);

/// Returns on which side of the plane through a, b and c the point p is: 1, −1, or 0 if p is on the plane.
int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& p);

struct PolyhedronFace {
  Plane plane;                      ///< the polyhedron is on the side where the plane's height is ≥ 0
  std::vector<std::uint32_t> loop;  ///< indices of corners, counter-clockwise seen from outside
};

enum class Extent {
  solid,
  flat,   ///< no volume: the wedge only touches the box, or lies in a plane. No faces; later planes are not examined
  empty,  ///< the empty set
};

struct Polyhedron {
  Extent extent = Extent::solid;
  std::vector<ExactPoint> corners;
  std::vector<PolyhedronFace> faces;
};

/// Returns box ∩ half-spaces, without rounding. Coefficients must be finite.
Polyhedron cut_box(const Box& box, std::span<const Plane> planes);

/// Returns the reason why a solid polyhedron is not closed (each edge once in either direction, V − E + F = 2), convex
/// (no corner outside a face) or oriented outward; nullopt if the polyhedron is all three. Exact.
std::optional<std::string> flaw_of(const Polyhedron& polyhedron);

/// Returns whether p is inside or on the mesh, computed from the corners of the faces alone (on which side of each face
/// p is), without the planes of the construction. Exact.
bool mesh_holds(const Polyhedron& polyhedron, const glm::dvec3& p);

}  // namespace penumbra::volumes
