// SPDX-License-Identifier: Apache-2.0
// Sheets and boxes of cells on a lattice of integers, and the counts of their diagnosis as formulas: a closed surface
// of n quads has n + 2 vertices (Euler), a sheet of n × n cells has 4 n boundary edges.

#include "mesh/shapes/broken_lattice.hpp"

#include <utility>

namespace penumbra::mesh::broken {

std::size_t LatticeMesh::Hash::operator()(const glm::ivec3& place) const {
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    hash = (hash ^ static_cast<std::uint32_t>(place[axis])) * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 32;
  }
  return hash;
}

std::uint32_t LatticeMesh::new_vertex(const glm::ivec3& place) {
  positions.push_back(place);
  return static_cast<std::uint32_t>(positions.size() - 1);
}

std::uint32_t LatticeMesh::vertex(const glm::ivec3& place) {
  const auto [entry, is_new] = numbers_.try_emplace(place, 0u);
  if (is_new) entry->second = new_vertex(place);
  return entry->second;
}

void LatticeMesh::add_cell(const Sheet& sheet, int i, int j) {
  const glm::ivec3 place = sheet.origin + i * sheet.u + j * sheet.v;
  const std::uint32_t a = vertex(place), b = vertex(place + sheet.u);
  const std::uint32_t c = vertex(place + sheet.u + sheet.v), d = vertex(place + sheet.v);
  add(a, b, c);
  add(a, c, d);
}

void LatticeMesh::add_sheet(const Sheet& sheet) {
  add_sheet(sheet, [](int, int) { return true; });
}

void LatticeMesh::add_sides(const glm::ivec3& low, const glm::ivec3& cells) {
  add_sheet({low, kZ, kY, cells.z, cells.y});
  add_sheet({low, kY, kX, cells.y, cells.x});
  add_sheet({low + cells.x * kX, kY, kZ, cells.y, cells.z});
  add_sheet({low + cells.z * kZ, kX, kY, cells.x, cells.y});
}

void LatticeMesh::add_open_box(const glm::ivec3& low, const glm::ivec3& cells) {
  add_sheet({low, kX, kZ, cells.x, cells.z});
  add_sides(low, cells);
}

void LatticeMesh::add_box(const glm::ivec3& low, const glm::ivec3& cells) {
  add_sheet({low + cells.y * kY, kZ, kX, cells.z, cells.x});
  add_open_box(low, cells);
}

void LatticeMesh::lift_from_here(Lift how) {
  apart();
  lift = how;
  lifted_from = positions.size();
}

void LatticeMesh::separate() {
  const std::vector<glm::ivec3> shared = std::exchange(positions, {});
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = new_vertex(shared[corner]);
  }
  apart();
}

void LatticeMesh::turn(std::size_t triangle) {
  std::swap(triangles[triangle][1], triangles[triangle][2]);
}

// A closed surface of quads has two vertices more than quads.
KnownDiagnosis known_box(std::uint64_t n) {
  KnownDiagnosis known;
  known.triangles = 12 * n * n;
  known.vertices = 6 * n * n + 2;
  known.components = 1;
  return known;
}

KnownDiagnosis known_sheet(std::uint64_t n) {
  KnownDiagnosis known;
  known.triangles = 2 * n * n;
  known.vertices = (n + 1) * (n + 1);
  known.components = known.boundary_loops = 1;
  known.boundary_edges = 4 * n;
  open(known);
  return known;
}

void add(KnownDiagnosis& sum, const KnownDiagnosis& part) {
  sum.triangles += part.triangles;
  sum.vertices += part.vertices;
  sum.components += part.components;
  sum.closed = sum.closed && part.closed;
  sum.closed_as_wound = sum.closed_as_wound && part.closed_as_wound;
  sum.boundary_edges += part.boundary_edges;
  sum.boundary_loops += part.boundary_loops;
  sum.non_manifold_edges += part.non_manifold_edges;
  sum.non_manifold_vertices += part.non_manifold_vertices;
  sum.inconsistent_windings += part.inconsistent_windings;
  sum.duplicate_faces += part.duplicate_faces;
  sum.opposite_faces += part.opposite_faces;
  sum.zero_area_triangles += part.zero_area_triangles;
  sum.needles += part.needles;
  sum.t_junctions += part.t_junctions;
  sum.self_intersections += part.self_intersections;
}

}  // namespace penumbra::mesh::broken
