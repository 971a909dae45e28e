#pragma once

#include "mesh/edge_graph.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// What is wrong with a soup of triangles, counted by definitions that have one answer. Vertices, edges and which
/// triangles have no area are the edge graph's (exact); so are all counts here but `needles` (a threshold, in double).
namespace penumbra::mesh {

/// One defect's place: the vertices that mark it and the triangles that it concerns.
struct DefectPlace {
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> triangles;  ///< of the soup
};

/// How often a defect occurs, and where the first ones (DiagnosisOptions::list_limit) are.
struct Defect {
  std::uint64_t count = 0;
  std::vector<DefectPlace> first;
};

struct DiagnosisOptions {
  double weld = 0;                            ///< see build_edge_graph
  bool search_intersections = true;           ///< the search that may take long: see find_self_intersections
  std::size_t list_limit = 16;                ///< places listed of each defect
  std::function<void(double)> progress = {};  ///< share done, in [0, 1]; may be empty; called from one thread at a time
};

struct Diagnosis {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;    ///< different points among the triangles' corners
  std::uint64_t components = 0;  ///< sets of triangles connected through shared edges; a triangle that repeats a vertex
                                 ///< has no edges and belongs to none

  /// Watertight by winding: once neighbours across edges of two triangles are turned to agree (how: turns_to_agree in
  /// mesh/diagnosis/winding.hpp), the winding number is an integer at every point of space. That is: the signed
  /// boundary is exactly zero *as a set of points with multiplicity*, wherever its edges are split (so a boundary that
  /// is closed by another component's edges, or across T-junctions, is closed), and a sheet that is merely doubled is
  /// not.
  bool closed = false;
  /// Closed with the triangles wound as they are, none turned.
  bool closed_as_wound = false;

  Defect boundary_edges;             ///< exactly one triangle
  std::uint64_t boundary_loops = 0;  ///< sets of boundary edges linked where two end at a vertex in the same fan (see
                                     ///< non_manifold_vertices): two sheets that touch in a vertex have two loops, two
                                     ///< holes of one sheet that touch are one loop, as in a half-edge structure
  Defect non_manifold_edges;         ///< more than two triangles
  Defect non_manifold_vertices;  ///< the triangles at the vertex form more than one fan (linked through edges there)
  Defect inconsistent_windings;  ///< edges of exactly two triangles that both run along it the same way
  Defect duplicate_faces;        ///< triangles with the same three (different) vertices and winding as an earlier one
  Defect opposite_faces;         ///< pairs of triangles with the same three vertices wound the other way (each triangle
                                 ///< in one pair at most)
  Defect zero_area_triangles;    ///< collinear, or a repeated vertex
  Defect needles;                ///< with an area, but lowest altitude < kNeedle times the longest edge
  Defect t_junctions;            ///< (vertex, edge): the vertex lies exactly inside the open edge
  std::optional<Defect> self_intersections;  ///< pairs of triangles with an area that meet elsewhere than in a shared
                                             ///< vertex or edge; nothing if not searched

  double volume = 0;  ///< signed, as wound, relative to the bounds' centre; the enclosed volume if closed_as_wound
  glm::dvec3 lower{0}, upper{0};  ///< bounds of the triangles' corners

  /// What float32 does to it: positions are taken relative to the bounds' centre (docs/definitions.md, "Scene floats").
  double largest_coordinate = 0;     ///< in absolute value, as the file has it
  double float_spacing = 0;          ///< of floats at the farthest corner from the centre
  double shortest_edge = 0;          ///< that is not zero
  std::uint64_t vertices_lost = 0;   ///< how many fewer different vertices there are in float32
  std::uint64_t triangles_lost = 0;  ///< triangles with an area that lose it in float32
};

inline constexpr double kNeedle = 1e-3;

/// Linear in memory. Deterministic: lists are in ascending order of triangle numbers.
Diagnosis diagnose(const MeshView& mesh, const DiagnosisOptions& options = {});

}  // namespace penumbra::mesh
