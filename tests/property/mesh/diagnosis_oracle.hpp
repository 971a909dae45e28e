// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/diagnosis/diagnosis.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <vector>

/// A second version of mesh/diagnosis/diagnosis.hpp, written directly from its definitions, in quadratic time or worse.
/// For soups whose coordinates are small integers: all arithmetic that decides is in integers, except for the winding
/// numbers.
namespace penumbra::mesh::oracle {

struct Point {
  std::int64_t x = 0, y = 0, z = 0;
  auto operator<=>(const Point&) const = default;
};
using Corners = std::array<Point, 3>;
using Segment = std::pair<Point, Point>;  // first < second

/// The counts of a Diagnosis without needles and self-intersections.
struct Counts {
  std::uint64_t vertices = 0, components = 0, boundary_edges = 0, boundary_loops = 0, non_manifold_edges = 0,
                non_manifold_vertices = 0, inconsistent_windings = 0, duplicate_faces = 0, opposite_faces = 0,
                zero_area_triangles = 0, t_junctions = 0;
  bool closed = false, closed_as_wound = false;

  friend bool operator==(const Counts&, const Counts&) = default;
};

Counts count(const std::vector<Corners>& soup);
Counts counts_of(const Diagnosis& diagnosis);
std::ostream& operator<<(std::ostream& out, const Counts& counts);

/// Returns the sum of the signed solid angles of the triangles, divided by 4π (van Oosterom, Strackee 1983).
double winding_number(const std::vector<Corners>& soup, const glm::dvec3& q);

/// Counts self-intersections by exact constructions: finds the points that two triangles share, and whether they are
/// part of a vertex or edge of both.
std::uint64_t count_self_intersections(const std::vector<Corners>& soup);

}  // namespace penumbra::mesh::oracle
