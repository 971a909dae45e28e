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

/// A wedge cut by a box, as a polyhedron whose corners are exact rationals. Internal to this room: GMP's types.
namespace penumbra::volumes {

struct ExactPoint {
  std::array<mpq_class, 3> at;
  glm::dvec3 near{0};  ///< each coordinate within 2⁻⁵² of itself

  ExactPoint() = default;
  explicit ExactPoint(const glm::dvec3& p);
  explicit ExactPoint(std::array<mpq_class, 3> exact);
};

/// a x + b y + c z + d, exactly.
mpq_class height_of(const Plane& plane, const ExactPoint& p);
/// Its sign: in double where that is certain.
int side_of(const Plane& plane, const ExactPoint& p);

/// The sign of (a, b, c; p).
int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& p);

struct PolyhedronFace {
  Plane plane;                      ///< the polyhedron is where it is ≥ 0
  std::vector<std::uint32_t> loop;  ///< corners, counter-clockwise seen from outside
};

enum class Extent {
  solid,
  flat,   ///< no volume: the box is touched only, or all is in a plane. No faces; planes after that are not looked at
  empty,  ///< nothing at all
};

struct Polyhedron {
  Extent extent = Extent::solid;
  std::vector<ExactPoint> corners;
  std::vector<PolyhedronFace> faces;
};

/// box ∩ half-spaces, without rounding. Coefficients must be finite.
Polyhedron cut_box(const Box& box, std::span<const Plane> planes);

/// What keeps a solid polyhedron from being closed (each edge once either way, V − E + F = 2), convex (no corner
/// outside a face) or oriented outward; nothing if it is all that. Exact.
std::optional<std::string> flaw_of(const Polyhedron& polyhedron);

/// Is p inside or on the mesh? By the side of three corners of each face, whatever planes they came from. Exact.
bool mesh_holds(const Polyhedron& polyhedron, const glm::dvec3& p);

}  // namespace penumbra::volumes
