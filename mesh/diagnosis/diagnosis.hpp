// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/edge_graph.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Defects of a triangle soup, counted by definitions that have one answer. Vertices, edges and zero areas come from
/// the edge graph (exact); all counts here are exact except `needles` (a threshold, in double).
namespace penumbra::mesh {

/// The place of one defect: the vertices that mark it and the triangles involved.
struct DefectPlace {
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> triangles;  ///< indices into the soup
};

/// The number of defects of one kind, and the places of the first ones (DiagnosisOptions::list_limit).
struct Defect {
  std::uint64_t count = 0;
  std::vector<DefectPlace> first;
};

struct DiagnosisOptions {
  double weld = 0;                            ///< see build_edge_graph
  bool search_intersections = true;           ///< this search may take long: see find_self_intersections
  std::size_t list_limit = 16;                ///< number of places listed for each kind of defect
  std::function<void(double)> progress = {};  ///< called with the fraction done, in [0, 1]; may be empty; calls do not
                                              ///< overlap
};

struct Diagnosis {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;    ///< different points among the triangles' corners
  std::uint64_t components = 0;  ///< sets of triangles connected through shared edges; a triangle that repeats a vertex
                                 ///< has no edges and belongs to none

  /// Watertight by winding: after neighbours across edges of two triangles have been turned to agree (see
  /// turns_to_agree in mesh/diagnosis/winding.hpp), the winding number is an integer at every point of space. That is:
  /// the signed boundary is exactly zero *as a set of points with multiplicity*, regardless of where its edges are
  /// split (so a boundary that is closed by another component's edges, or across T-junctions, is closed), and a sheet
  /// that is merely doubled is not closed.
  bool closed = false;
  /// Closed with the stored windings, no triangle turned.
  bool closed_as_wound = false;

  Defect boundary_edges;             ///< edges with exactly one triangle
  std::uint64_t boundary_loops = 0;  ///< sets of boundary edges linked where two end at a vertex in the same fan (see
                                     ///< non_manifold_vertices): two sheets that touch in a vertex have two loops, two
                                     ///< holes of one sheet that touch are one loop, as in a half-edge structure
  Defect non_manifold_edges;         ///< edges with more than two triangles
  Defect non_manifold_vertices;  ///< the triangles at the vertex form more than one fan (linked through edges there)
  Defect inconsistent_windings;  ///< edges of exactly two triangles that both traverse it in the same direction
  Defect duplicate_faces;        ///< triangles with the same three (different) vertices and winding as an earlier one
  Defect opposite_faces;         ///< pairs of triangles with the same three vertices and opposite windings (each
                                 ///< triangle in at most one pair)
  Defect zero_area_triangles;    ///< collinear, or a repeated vertex
  Defect needles;                ///< area not zero, but lowest altitude < kNeedle times the longest edge
  Defect t_junctions;            ///< (vertex, edge): the vertex lies exactly inside the open edge
  std::optional<Defect> self_intersections;  ///< pairs of triangles with an area that meet elsewhere than in a shared
                                             ///< vertex or edge; nullopt if not searched

  double volume = 0;  ///< signed, as wound, relative to the bounds' centre; the enclosed volume if closed_as_wound
  glm::dvec3 lower{0}, upper{0};  ///< bounds of the triangles' corners

  /// Effect of conversion to float32: positions are taken relative to the bounds' centre (docs/definitions.md, "Scene
  /// floats").
  double largest_coordinate = 0;     ///< in absolute value, as stored in the file
  double float_spacing = 0;          ///< of floats at the farthest corner from the centre
  double shortest_edge = 0;          ///< the shortest edge of non-zero length
  std::uint64_t vertices_lost = 0;   ///< difference between the numbers of different vertices in double and in float32
  std::uint64_t triangles_lost = 0;  ///< triangles with non-zero area in double and zero area in float32
};

inline constexpr double kNeedle = 1e-3;

/// Diagnoses a mesh. Memory is linear in the mesh. Deterministic: lists are in ascending order of triangle indices.
Diagnosis diagnose(const MeshView& mesh, const DiagnosisOptions& options = {});

}  // namespace penumbra::mesh
