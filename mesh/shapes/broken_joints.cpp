// SPDX-License-Identifier: Apache-2.0
// Defects of sheets, and of parts that touch, overlap or cross; s cells along an edge. Sheets stand upright.

#include "mesh/shapes/broken_lattice.hpp"

#include <array>
#include <utility>

namespace penumbra::mesh::broken {
namespace {

using Known = KnownDiagnosis;
using Count = std::uint64_t;

Sheet wall(int s) {
  return {{0, 0, 0}, kX, kY, s, s};
}

Known twice(Known known) {
  add(known, Known(known));
  return known;
}

void build_sheet(LatticeMesh& mesh, int s) {
  mesh.add_sheet(wall(s));
}

/// Returns the number of edges of a sheet of s² cells that are not on its rim.
Count inner_edges(Count s) {
  return 3 * s * s - 2 * s;
}

/// Builds both sides of a sheet, on the same vertices: closed, with nothing inside.
void build_pillow(LatticeMesh& mesh, int s) {
  build_sheet(mesh, s);
  mesh.add_sheet({{0, 0, 0}, kY, kX, s, s});
}
Known know_pillow(Count s) {
  Known known;
  known.triangles = 4 * s * s;
  known.vertices = (s + 1) * (s + 1);
  known.components = 1;
  known.opposite_faces = known.self_intersections = 2 * s * s;
  known.non_manifold_edges = inner_edges(s);
  return known;
}

void build_doubled_sheet(LatticeMesh& mesh, int s) {
  build_sheet(mesh, s);
  build_sheet(mesh, s);
}
/// On the rim each triangle meets its double across an edge of two triangles. A face and its double are not neighbours
/// that could be turned to agree (the two would cancel): the sheet stays open.
Known know_doubled_sheet(Count s) {
  Known known = know_pillow(s);
  known.duplicate_faces = std::exchange(known.opposite_faces, 0);
  known.inconsistent_windings = 4 * s;
  open(known);
  return known;
}

void build_doubled_box(LatticeMesh& mesh, int s) {
  box(mesh, s);
  box(mesh, s);
}
/// The box has 18 s² edges, each with four triangles; the winding number inside is 2.
Known know_doubled_box(Count s) {
  Known known = known_box(s);
  known.duplicate_faces = known.self_intersections = 12 * s * s;
  known.triangles *= 2;
  known.non_manifold_edges = 18 * s * s;
  return known;
}

/// Builds a square ring with 2 s cells on each side between its corners. It lies flat except on its first side, where
/// it turns upright and then upside down.
void build_moebius(LatticeMesh& mesh, int s) {
  const int near = kCell, far = (2 * s + 1) * kCell, out = (2 * s + 2) * kCell, half = kCell / 2;
  using Rung = std::pair<glm::ivec3, glm::ivec3>;  // from inside to outside; after the turn, from outside to inside
  std::vector<Rung> rungs;
  const glm::ivec3 inner[] = {{near, half, near}, {far, half, near}, {far, half, far}, {near, half, far}};
  const glm::ivec3 outer[] = {{0, half, 0}, {out, half, 0}, {out, half, out}, {0, half, out}};
  const glm::ivec3 along[] = {kX, kZ, -kX, -kZ}, outward[] = {-kZ, kX, kZ, -kX};
  for (int side = 0; side < 4; ++side) {
    for (int k = 0; k <= 2 * s; ++k) {
      const glm::ivec3 inside = inner[side] + k * along[side], outside = inside + outward[side];
      const glm::ivec3 middle = (inside + outside) / 2;
      if (side > 0 || k == 2 * s) {
        rungs.emplace_back(outside, inside);
      } else if (k == 0) {
        rungs.emplace_back(inside, outside);
      } else {
        rungs.emplace_back(middle + kY / 2, middle - kY / 2);
      }
    }
    rungs.emplace_back(outer[(side + 1) % 4], inner[(side + 1) % 4]);
  }
  rungs.emplace_back(rungs[0].second, rungs[0].first);
  for (std::size_t i = 0; i + 1 < rungs.size(); ++i) {
    const std::uint32_t p = mesh.vertex(rungs[i].first), q = mesh.vertex(rungs[i].second);
    const std::uint32_t next_p = mesh.vertex(rungs[i + 1].first), next_q = mesh.vertex(rungs[i + 1].second);
    if (q != next_q) mesh.add(p, q, next_q);
    if (p != next_p) mesh.add(p, next_q, next_p);
  }
}
/// There are 2 · 2 s triangles on each side and 2 at each corner. Each triangle has one side on the rim, which visits
/// every vertex once.
Known know_moebius(Count s) {
  Known known;
  open(known);
  known.triangles = known.vertices = known.boundary_edges = 16 * s + 8;
  known.components = known.boundary_loops = known.inconsistent_windings = 1;
  return known;
}

void build_shared_edge(LatticeMesh& mesh, int s) {
  box(mesh, s);
  box(mesh, s, s * (kX + kY));
}
Known know_shared_edge(Count s) {
  Known known = twice(known_box(s));
  known.vertices -= s + 1;
  known.components = 1;
  known.non_manifold_edges = s;
  return known;
}

/// Builds one sheet across the middle of a box of 2 s cells.
void build_inner_wall(LatticeMesh& mesh, int s) {
  mesh.add_box({0, 0, 0}, {2 * s, s, s});
  mesh.add_sheet({s * kX, kY, kZ, s, s});
}
Known know_inner_wall(Count s) {
  Known known;
  open(known);
  known.triangles = 20 * s * s + 2 * s * s;
  known.vertices = 10 * s * s + 2 + (s - 1) * (s - 1);
  known.components = 1;
  known.non_manifold_edges = 4 * s;
  return known;
}

/// Builds two boxes with a common side, which exists twice, once for each box.
void build_shared_wall(LatticeMesh& mesh, int s) {
  box(mesh, s);
  box(mesh, s, s * kX);
}
Known know_shared_wall(Count s) {
  Known known = twice(known_box(s));
  known.vertices -= (s + 1) * (s + 1);
  known.components = 1;
  known.opposite_faces = known.self_intersections = 2 * s * s;
  known.non_manifold_edges = inner_edges(s) + 4 * s;
  return known;
}

void build_bowtie(LatticeMesh& mesh, int s) {
  box(mesh, s);
  box(mesh, s, s * (kX + kY + kZ));
}
Known know_bowtie(Count s) {
  Known known = twice(known_box(s));
  known.vertices -= 1;
  known.non_manifold_vertices = 1;
  return known;
}

void build_bowtie_sheets(LatticeMesh& mesh, int s) {
  build_sheet(mesh, s);
  mesh.add_sheet({s * (kX + kY), kX, kY, s, s});
}
Known know_bowtie_sheets(Count s) {
  Known known = twice(known_sheet(s));
  known.vertices -= 1;
  known.non_manifold_vertices = 1;
  return known;
}

/// Builds a flat sheet, and an upright one that crosses its first column of cells in the middle: along the line both
/// are cut into pieces. The first is cut at j and j + 1/2. The second starts at 1/8 and is crossed at a quarter of a
/// cell's height, so it is cut at j + 1/8 and j + 3/8.
void build_crossing_sheets(LatticeMesh& mesh, int s) {
  const int height = s / 2 * kCell + kCell / 4;
  mesh.add_sheet({{0, height, 0}, kZ, kX, s, s});
  mesh.add_sheet({{kCell / 2, 0, kCell / 8}, kY, kZ, s, s});
}
/// The line's common part runs from 1/8 to s. Inside it are 2 s − 1 ends of the first sheet's pieces and 2 s − 1 of the
/// second's, all at different places: each begins another pair.
Known know_crossing_sheets(Count s) {
  Known known = twice(known_sheet(s));
  known.self_intersections = 4 * s - 1;
  return known;
}

/// Returns a place inside the triangle abc of cell i of the top of s³ cells, `dx`, `dz` eighths of a cell from the
/// cell's (1/4, 3/4). Within ±1/8 it stays inside: c = (1, 1) and b = (0, 1), and it is on the side of ac where z > x.
glm::ivec3 in_top(int s, int i, int dx, int dz) {
  return s * kY + i * kZ + glm::ivec3((2 + dx) * kCell / 8, 0, (6 + dz) * kCell / 8);
}

/// Builds triangles whose tips pierce the top.
void build_piercing(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; ++i) {
    const std::uint32_t tip = mesh.vertex(in_top(s, i, 0, 0) - kY / 4);
    mesh.add(tip, mesh.vertex(in_top(s, i, 1, 0) + kY / 4), mesh.vertex(in_top(s, i, 0, 1) + kY / 4));
  }
}
Known loose_triangles(Count s) {
  Known known;
  open(known);
  known.triangles = known.components = known.boundary_loops = s;
  known.vertices = known.boundary_edges = 3 * s;
  return known;
}
Known know_piercing(Count s) {
  Known known = known_box(s);
  add(known, loose_triangles(s));
  known.self_intersections = s;
  return known;
}

/// Builds tetrahedra whose tips pierce the top: three of the four sides cross it.
void build_spikes(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; ++i) {
    const std::uint32_t tip = mesh.vertex(in_top(s, i, 0, 0) - kY / 4), a = mesh.vertex(in_top(s, i, -1, -1) + kY / 4),
                        b = mesh.vertex(in_top(s, i, 0, 1) + kY / 4), c = mesh.vertex(in_top(s, i, 1, 0) + kY / 4);
    mesh.add(a, b, c);
    mesh.add(tip, b, a);
    mesh.add(tip, c, b);
    mesh.add(tip, a, c);
  }
}
Known know_spikes(Count s) {
  Known known = known_box(s);
  known.triangles += 4 * s;
  known.vertices += 4 * s;
  known.components += s;
  known.self_intersections = 3 * s;
  return known;
}

/// Builds triangles that lie in the top.
void build_decals(LatticeMesh& mesh, int s) {
  box(mesh, s);
  for (int i = 0; i < s; ++i) {
    mesh.add(mesh.vertex(in_top(s, i, -1, -1)), mesh.vertex(in_top(s, i, 0, 1)), mesh.vertex(in_top(s, i, 1, 0)));
  }
}

/// Builds two sheets on a plane: the last cell of the first and the first cell of the second overlap. The second is
/// shifted half a cell along the row, a quarter across: of the four pairs of triangles, only abc of the second and acd
/// of the first do not meet, since the diagonals keep them apart.
void build_overlap(LatticeMesh& mesh, int s) {
  build_sheet(mesh, s);
  mesh.add_sheet({(s - 1) * (kX + kY) + kX / 2 + kY / 4, kX, kY, s, s});
}
Known know_overlap(Count s) {
  Known known = twice(known_sheet(s));
  known.self_intersections = 3;
  return known;
}

void build_nested(LatticeMesh& mesh, int s) {
  box(mesh, 2 * s);
  box(mesh, s, s * (kX + kY + kZ) / 2);
}
void build_hollow(LatticeMesh& mesh, int s) {
  box(mesh, 2 * s);
  const std::size_t outer = mesh.triangles.size();
  box(mesh, s, s * (kX + kY + kZ) / 2);
  for (std::size_t i = outer; i < mesh.triangles.size(); ++i) mesh.turn(i);
}
Known know_nested(Count s) {
  Known known = known_box(2 * s);
  add(known, known_box(s));
  return known;
}

void build_loose_triangles(LatticeMesh& mesh, int s) {
  for (int i = 0; i < s; ++i) {
    const glm::ivec3 place = i * (kX + kX / 2);
    mesh.add(mesh.vertex(place), mesh.vertex(place + kX), mesh.vertex(place + kY));
  }
}

constexpr std::array kSheetDefects{
    Defect{"sheet", "an open sheet", build_sheet, known_sheet},
    Defect{"pillow", "a sheet twice, wound both ways", build_pillow, know_pillow},
    Defect{"doubled-sheet", "a sheet twice, wound the same way", build_doubled_sheet, know_doubled_sheet},
    Defect{"doubled-box", "a box twice", build_doubled_box, know_doubled_box},
    Defect{"moebius", "a strip with one side", build_moebius, know_moebius},
    Defect{"loose-triangles", "triangles that touch nothing", build_loose_triangles, loose_triangles},
};

constexpr std::array kJointDefects{
    Defect{"shared-edge", "two boxes that share edges", build_shared_edge, know_shared_edge},
    Defect{"inner-wall", "a box with one sheet across its middle", build_inner_wall, know_inner_wall},
    Defect{"shared-wall", "two boxes that share a side", build_shared_wall, know_shared_wall},
    Defect{"bowtie", "two boxes that share a vertex", build_bowtie, know_bowtie},
    Defect{"bowtie-sheets", "two sheets that share a vertex", build_bowtie_sheets, know_bowtie_sheets},
    Defect{"crossing-sheets", "two sheets through each other", build_crossing_sheets, know_crossing_sheets},
    Defect{"piercing", "loose triangles stuck through a box", build_piercing, know_piercing},
    Defect{"spikes", "tetrahedra stuck through a box", build_spikes, know_spikes},
    Defect{"decals", "loose triangles on the plane of a box's top", build_decals, know_piercing},
    Defect{"overlap", "two sheets on a plane that overlap", build_overlap, know_overlap},
    Defect{"nested", "a box inside a box", build_nested, know_nested},
    Defect{"hollow", "a box inside a box, wound inside out", build_hollow, know_nested},
};

}  // namespace

std::span<const Defect> sheet_defects() {
  return kSheetDefects;
}

std::span<const Defect> joint_defects() {
  return kJointDefects;
}

}  // namespace penumbra::mesh::broken
