// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.hpp"
#include "base/memory.hpp"
#include "mesh/shapes/shapes.hpp"
#include "mesh/soup_memory.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

/// Shared by the shape generators; not part of the folder's interface.
namespace penumbra::mesh::builder {

inline constexpr double kTau = 2 * std::numbers::pi;

/// Returns `size`; throws if it exceeds the limit of shapes.
inline ShapeSize checked(const ShapeSize& size) {
  if (size.triangles > kMaxShapeTriangles) {
    throw InputError("the shape would have {} triangles; at most {} are generated", size.triangles, kMaxShapeTriangles);
  }
  return size;
}

/// Throws before memory is allocated that this process cannot have.
inline void require_room(const ShapeSize& size) {
  require_memory(soup_bytes(size.triangles, size.vertices), fmt::format("a shape of {} triangles", size.triangles),
                 "make it smaller");
}

/// Returns an empty soup with reserved memory.
inline TriangleSoup soup_with_room(const ShapeSize& size) {
  require_room(size);
  TriangleSoup soup;
  soup.positions.reserve(size.vertices);
  soup.triangles.reserve(size.triangles);
  return soup;
}

inline std::uint32_t add_vertex(TriangleSoup& soup, const glm::dvec3& position) {
  soup.positions.push_back(position);
  return static_cast<std::uint32_t>(soup.positions.size() - 1);
}

inline void add_quad(TriangleSoup& soup, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  soup.triangles.push_back({a, b, c});
  soup.triangles.push_back({a, c, d});
}

/// The corners of a box's six sides, counter-clockwise from outside; bits 0, 1, 2 of a corner mean the upper end of x,
/// y, z. The side at −Z comes last.
inline constexpr std::array<std::array<std::uint32_t, 4>, 6> kBoxSides{
    {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}};

/// Adds eight corners in the numbering of kBoxSides; returns the first index.
std::uint32_t add_box_corners(TriangleSoup& soup, const glm::dvec3& low, const glm::dvec3& high);
void add_box(TriangleSoup& soup, const glm::dvec3& low, const glm::dvec3& high);
void append(TriangleSoup& soup, const TriangleSoup& other);

/// Adds the faces of a tube closed in both directions: vertex (i, j) is first + i · sides + j. Normals are outward if
/// the sides run counter-clockwise about the direction of growing i.
void add_ring_faces(TriangleSoup& soup, std::uint32_t segments, std::uint32_t sides);

/// Fills object and source_face: each triangle is its own face.
TriangleSoup finish(TriangleSoup soup);

}  // namespace penumbra::mesh::builder
