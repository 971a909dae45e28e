// SPDX-License-Identifier: Apache-2.0
// Defects in the surface of a closed box of s³ cells. Each is made once in every cell of the top's first row (s times)
// unless noted; "patch" is a square of h = ⌈s/2⌉ cells in the top's first corner.

#include "mesh/shapes/broken_lattice.hpp"

#include <array>
#include <utility>

namespace penumbra::mesh::broken {
namespace {

using Known = KnownDiagnosis;
using Count = std::uint64_t;

template <typename Number>
Number patch(Number s) {
  return (s + 1) / 2;
}

void build_hole(LatticeMesh& mesh, int s) {
  mesh.add_sheet(top(s), [h = patch(s)](int i, int j) { return i >= h || j >= h; });
  mesh.add_open_box({0, 0, 0}, {s, s, s});
}
Known know_hole(Count s) {
  const Count h = patch(s);
  Known known = known_box(s);
  open(known);
  known.triangles -= 2 * h * h;
  known.vertices -= (h - 1) * (h - 1);
  known.boundary_edges = 4 * h;
  known.boundary_loops = 1;
  return known;
}

/// Removes every other cell of every other row, in the top and in the bottom: h² holes each, none of which touch.
void build_holes(LatticeMesh& mesh, int s) {
  const auto keep = [](int i, int j) { return i % 2 == 1 || j % 2 == 1; };
  mesh.add_sheet(top(s), keep);
  mesh.add_sheet({{0, 0, 0}, kX, kZ, s, s}, keep);
  mesh.add_sides({0, 0, 0}, {s, s, s});
}
Known know_holes(Count s) {
  const Count holes = 2 * patch(s) * patch(s);
  Known known = known_box(s);
  open(known);
  known.triangles -= 2 * holes;
  known.boundary_edges = 4 * holes;
  known.boundary_loops = holes;
  return known;
}

/// Removes cells (0, 0) and (1, 1) of a top of (s + 1)² cells: the vertex between them has two fans, each from a side
/// of one hole to a side of the other. Followed through the fans, the boundary is one loop.
void build_touching_holes(LatticeMesh& mesh, int s) {
  mesh.add_sheet(top(s + 1), [](int i, int j) { return i != j || i > 1; });
  mesh.add_open_box({0, 0, 0}, glm::ivec3(s + 1));
}
Known know_touching_holes(Count s) {
  Known known = known_box(s + 1);
  open(known);
  known.triangles -= 4;
  known.boundary_edges = 8;
  known.boundary_loops = 1;
  known.non_manifold_vertices = 1;
  return known;
}

void build_flipped_triangle(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; ++i) mesh.turn(2 * static_cast<std::size_t>(i));
}
Known know_flipped_triangle(Count s) {
  Known known = known_box(s);
  known.closed_as_wound = false;
  known.inconsistent_windings = 3 * s;  // no two of the flipped triangles are neighbours
  return known;
}

void build_flipped_patch(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int j = 0; j < patch(s); ++j) {
    for (int i = 0; i < 2 * patch(s); ++i)
      mesh.turn(2 * static_cast<std::size_t>(s) * static_cast<std::size_t>(j) + static_cast<std::size_t>(i));
  }
}
Known know_flipped_patch(Count s) {
  Known known = known_box(s);
  known.closed_as_wound = false;
  known.inconsistent_windings = 4 * patch(s);
  return known;
}

void build_inside_out(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) mesh.turn(i);
}

void build_duplicate_face(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; ++i) {
    const Triangle again = mesh.triangles[2 * static_cast<std::size_t>(i)];
    mesh.triangles.push_back(again);
  }
}
Known know_duplicate_face(Count s) {
  Known known = known_box(s);
  open(known);
  known.triangles += s;
  known.duplicate_faces = known.self_intersections = s;
  known.non_manifold_edges = 3 * s;
  return known;
}

void build_opposite_face(LatticeMesh& mesh, int s) {
  build_duplicate_face(mesh, s);
  for (int i = 0; i < s; ++i) mesh.turn(mesh.triangles.size() - 1 - static_cast<std::size_t>(i));
}
Known know_opposite_face(Count s) {
  Known known = know_duplicate_face(s);
  known.opposite_faces = std::exchange(known.duplicate_faces, 0);
  return known;
}

/// Splits the side ab of cell i's triangle abc at its middle, but not the triangle across ab; returns a, b, the middle.
Triangle split_side(LatticeMesh& mesh, int i) {
  Triangle& triangle = mesh.triangles[2 * static_cast<std::size_t>(i)];
  const auto [a, b, c] = triangle;
  const std::uint32_t middle = mesh.vertex((mesh.positions[a] + mesh.positions[b]) / 2);
  triangle = {a, middle, c};
  mesh.add(middle, b, c);
  return {a, b, middle};
}

/// Each half of the split triangle meets the triangle across ab along half of ab. The two share no edge, because ab
/// itself is a side of neither half.
void add_split(Known& known, Count times) {
  known.triangles += times;
  known.vertices += times;
  known.t_junctions += times;
  known.self_intersections += 2 * times;
}

/// Splits every other cell, so that the cracks do not touch.
void build_t_junction(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; i += 2) split_side(mesh, i);
}
Known know_t_junction(Count s) {
  Known known = known_box(s);
  add_split(known, patch(s));
  known.boundary_edges = 3 * patch(s);
  known.boundary_loops = patch(s);
  return known;
}

/// Splits every cell: the cracks form one loop, with vertices along it where two fans meet.
void build_crack(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; ++i) split_side(mesh, i);
}
Known know_crack(Count s) {
  Known known = known_box(s);
  add_split(known, s);
  known.boundary_edges = 3 * s;
  known.boundary_loops = 1;
  known.non_manifold_vertices = s - 1;
  return known;
}

/// Builds a crack whose sides are joined by triangles without area.
void build_collinear(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; ++i) {
    const auto [a, b, middle] = split_side(mesh, i);
    mesh.add(a, b, middle);
  }
}
Known know_collinear(Count s) {
  Known known = known_box(s);
  add_split(known, s);
  known.triangles += s;
  known.zero_area_triangles = s;
  return known;
}

void build_repeated_vertex(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; ++i) {
    const auto [a, b, c] = mesh.triangles[2 * static_cast<std::size_t>(i)];
    switch (i % 3) {
      case 0:
        mesh.add(a, a, b);
        break;
      case 1:
        mesh.add(b, a, mesh.new_vertex(mesh.positions[a]));
        break;
      default:
        mesh.add(c, c, c);
    }
  }
}
Known know_repeated_vertex(Count s) {
  Known known = known_box(s);
  known.triangles += s;
  known.zero_area_triangles = s;
  return known;
}

/// Adds a vertex one lattice step inside the middle of ab: the triangle under it has the height of one step.
void build_needle(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; ++i) {
    const auto [a, b, c] = mesh.triangles[2 * static_cast<std::size_t>(i)];
    const std::uint32_t inside = mesh.vertex((mesh.positions[a] + mesh.positions[b]) / 2 + glm::ivec3(1, 0, 0));
    mesh.triangles[2 * static_cast<std::size_t>(i)] = {a, b, inside};
    mesh.add(b, c, inside);
    mesh.add(c, a, inside);
  }
}
Known know_needle(Count s) {
  Known known = known_box(s);
  known.triangles += 2 * s;
  known.vertices += s;
  known.needles = s;
  return known;
}

/// Adds a strip of cells that stands on the top's edge.
void build_fin(LatticeMesh& mesh, int s) {
  box(mesh, s);
  mesh.add_sheet({s * kY, kZ, kY, s, 1});
}
Known know_fin(Count s) {
  Known known = known_box(s);
  open(known);
  known.triangles += 2 * s;
  known.vertices += s + 1;
  known.boundary_edges = s + 2;
  known.boundary_loops = 1;
  known.non_manifold_edges = s;
  return known;
}

/// Builds the top with cells half as long: closed as a set of points, though no edge of the rim has two triangles. At
/// each middle of a rim edge three of the top's triangles meet the one below.
void build_lid(LatticeMesh& mesh, int s) {
  mesh.add_sheet({s * kY, kZ / 2, kX / 2, 2 * s, 2 * s});
  mesh.add_open_box({0, 0, 0}, {s, s, s});
}
Known know_lid(Count s) {
  Known known = known_box(s);
  known.triangles += 6 * s * s;
  known.vertices += (2 * s + 1) * (2 * s + 1) - 4 * s - (s - 1) * (s - 1);
  known.components = known.boundary_loops = 2;
  known.boundary_edges = 12 * s;
  known.t_junctions = known.non_manifold_vertices = 4 * s;
  known.self_intersections = 12 * s;
  return known;
}

/// Builds a hole, and its cut-out part slightly above.
void build_lifted(LatticeMesh& mesh, int s, Lift lift) {
  build_hole(mesh, s);
  mesh.lift_from_here(lift);
  mesh.add_sheet(top(s), [h = patch(s)](int i, int j) { return i < h && j < h; });
}
void build_gap(LatticeMesh& mesh, int s) {
  build_lifted(mesh, s, Lift::float_step);
}
void build_lost_gap(LatticeMesh& mesh, int s) {
  build_lifted(mesh, s, Lift::double_step);
}
Known know_gap(Count s) {
  Known known = know_hole(s);
  add(known, known_sheet(patch(s)));
  known.triangles = 12 * s * s;
  return known;
}

void build_unmerged(LatticeMesh& mesh, int s) {
  box(mesh, s);
  mesh.separate();
}

/// Uses twice as many cells, so that a row of vertices lies in the middle of the height, at y = 0 if the mesh's centre
/// is there.
void build_negative_zero(LatticeMesh& mesh, int s) {
  build_unmerged(mesh, 2 * s);
  mesh.signed_zeros = true;
}
Known know_negative_zero(Count s) {
  return known_box(2 * s);
}

constexpr std::array kSurfaceDefects{
    Defect{"none", "a clean closed box", box, known_box},
    Defect{"hole", "a hole in a box", build_hole, know_hole},
    Defect{"holes", "many holes in a box", build_holes, know_holes},
    Defect{"touching-holes", "two holes that touch in a vertex", build_touching_holes, know_touching_holes},
    Defect{"flipped-triangle", "single triangles wound the other way", build_flipped_triangle, know_flipped_triangle},
    Defect{"flipped-patch", "a patch wound the other way", build_flipped_patch, know_flipped_patch},
    Defect{"inside-out", "a box wound inside out", build_inside_out, known_box},
    Defect{"duplicate-face", "triangles twice, wound the same way", build_duplicate_face, know_duplicate_face},
    Defect{"opposite-face", "triangles twice, wound both ways", build_opposite_face, know_opposite_face},
    Defect{"t-junction", "vertices inside edges: cracks of no width", build_t_junction, know_t_junction},
    Defect{"crack", "a row of cracks of no width", build_crack, know_crack},
    Defect{"collinear", "triangles whose three vertices lie on a line", build_collinear, know_collinear},
    Defect{"repeated-vertex", "triangles two of whose vertices are one", build_repeated_vertex, know_repeated_vertex},
    Defect{"needle", "very thin triangles", build_needle, know_needle},
    Defect{"fin", "triangles that stand on edges of a box", build_fin, know_fin},
    Defect{"lid", "a box whose top has smaller cells", build_lid, know_lid},
    Defect{"gap", "a patch one float's step above its hole", build_gap, know_gap},
    Defect{"lost-gap", "a patch one double's step above its hole: a float does not see it", build_lost_gap, know_gap},
    Defect{"unmerged", "every triangle with vertices of its own", build_unmerged, known_box},
    Defect{"negative-zero", "zeros of both signs (where the mesh's centre is at zero)", build_negative_zero,
           know_negative_zero},
};

}  // namespace

std::span<const Defect> surface_defects() {
  return kSurfaceDefects;
}

}  // namespace penumbra::mesh::broken
