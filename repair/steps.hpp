// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"
#include "mesh/repair.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// The steps of repair, each a function from a soup to a repaired one that counts its changes. Inside repair/ only.
namespace penumbra::repair {

using mesh::build_edge_graph;
using mesh::Edge;
using mesh::EdgeGraph;
using mesh::Incidence;
using mesh::Repaired;
using mesh::RepairOptions;
using mesh::Triangle;
using mesh::TriangleKind;
using mesh::TriangleSoup;

enum class RepairKind : std::uint8_t {
  repeated,   ///< triangles removed: two corners at one point
  collinear,  ///< triangles removed: corners on a line
  split_face,
  duplicate,
  moved,
  merged,
  stitched,
  split_edge,
  split_vertex,
  turned,
  outward,
  hole,
  hole_face,
  intersection,
  unused,
  kinds,
};

struct RepairRecord {
  std::array<std::uint64_t, static_cast<std::size_t>(RepairKind::kinds)> done{};
  std::vector<std::string> left;

  std::uint64_t& operator[](RepairKind kind) { return done[static_cast<std::size_t>(kind)]; }
};

/// Removes triangles without area. Where one joined a vertex to the edge that the vertex lies on, the triangles of that
/// edge are split there, so that no crack opens. Cuts along lines only: the set of points stays the same.
TriangleSoup remove_empty_triangles(const TriangleSoup& soup, double weld, RepairRecord& record);

/// Removes triangles with the vertices and the winding of an earlier one; and the later of two oppositely wound
/// triangles where one of their edges has an odd number of triangles. Other opposite pairs are the two sides of a plate
/// or the wall between two solids: such parts are closed with the pair and open without it.
TriangleSoup remove_duplicates(const TriangleSoup& soup, double weld, RepairRecord& record);

/// Winds neighbours consistently, joins triangles that meet at an edge in pairs (at edges of more than two, the pairs
/// that have a solid between them), and gives each fan of joined triangles its own position: merged where the file
/// repeats a position, split where surfaces only touch. The result is an oriented manifold by its indices alone. All
/// triangles must have an area.
TriangleSoup join(const TriangleSoup& soup, double weld, RepairRecord& record);

/// Drops positions that no triangle uses.
TriangleSoup without_unused_positions(const TriangleSoup& soup);

// The steps below use CGAL, and take the result of join().

/// Winds closed parts so that they bound a volume: outward, and inward for cavities. Where parts intersect or touch, a
/// part is turned outward only if no other part's bounds contain it.
TriangleSoup turn_outward(const TriangleSoup& soup, RepairRecord& record);

TriangleSoup fill_holes(const TriangleSoup& soup, std::uint32_t most_edges, RepairRecord& record);

TriangleSoup resolve_intersections(const TriangleSoup& soup, RepairRecord& record);

}  // namespace penumbra::repair
