// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/diagnosis/diagnosis.hpp"
#include "mesh/shapes/shapes.hpp"
#include "mesh/triangle_soup.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Meshes with each defect that real files have, alone and combined, small and large, each with its known diagnosis:
/// the counts are formulas in the generator, not results of a search. Deterministic.
///
/// All coordinates (except those that a gap lifts by the smallest step) are whole multiples of a step that is a power
/// of two, for any centre and size: "exactly on" is exact in double, and in float as long as fewer than 2²³ steps lie
/// between a vertex and the scene's origin. A cell is 2048 steps long.
namespace penumbra::mesh {

/// The counts of Diagnosis that a generator predicts.
struct KnownDiagnosis {
  std::uint64_t triangles = 0, vertices = 0, components = 0;
  bool closed = true, closed_as_wound = true;
  std::uint64_t boundary_edges = 0, boundary_loops = 0, non_manifold_edges = 0, non_manifold_vertices = 0;
  std::uint64_t inconsistent_windings = 0, duplicate_faces = 0, opposite_faces = 0, zero_area_triangles = 0;
  std::uint64_t needles = 0, t_junctions = 0, self_intersections = 0;
};

struct BrokenMesh {
  TriangleSoup soup;
  KnownDiagnosis known;
};

struct BrokenShape {
  std::vector<std::string> defects;  ///< names from broken_defects(), in any number; each adds a separate part
  std::uint32_t size = 1;            ///< cells along an edge of a part: 1 the smallest, 64 a large mesh
  glm::dvec3 center{0};              ///< centre of the whole mesh's bounds, to the nearest step
  double half_extent = 1;            ///< largest half extent of the whole mesh, along its longest axis; at least half
                                     ///< of that is used
};

/// The available defects, each with a one-sentence description.
struct DefectName {
  std::string_view name, what;
};
std::span<const DefectName> broken_defects();

inline constexpr std::uint32_t kMaxBrokenSize = 2048;

/// Throws InputError for an unknown name (listing the known ones), for an empty list of names, a size of 0 or above
/// kMaxBrokenSize, and more triangles than kMaxShapeTriangles.
BrokenMesh make_broken_mesh(const BrokenShape& shape);
/// Returns the size; `vertices` counts only different ones. Throws as make_broken_mesh does.
ShapeSize shape_size(const BrokenShape& shape);

struct LatticeSoup {
  std::uint32_t triangles = 64;
  std::uint32_t cells = 4;  ///< corners are drawn from {0 … cells}³: fewer cells give more coincidences
  std::uint32_t seed = 1;
  glm::dvec3 center{0};    ///< centre of the lattice, to the nearest step
  double half_extent = 1;  ///< largest half extent of the lattice; at least half of that is used
};
/// Returns random triangles whose corners are drawn from a tiny lattice, so that duplicates, overlaps, T-junctions,
/// zero areas and non-manifold edges are frequent.
TriangleSoup make_lattice_soup(const LatticeSoup& soup);
ShapeSize shape_size(const LatticeSoup& soup);

}  // namespace penumbra::mesh
