// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/shapes/broken_meshes.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

/// Internal to this room: the parts of broken meshes, on a lattice of integers.
namespace penumbra::mesh::broken {

inline constexpr int kCell = 2048;  ///< lattice steps along a cell: a needle one step high is below kNeedle

/// A flat sheet of cells_u × cells_v cells that faces u × v. Cell (i, j) has the corners a = origin + i·u + j·v,
/// b = a + u, c = a + u + v, d = a + v and the triangles abc, acd.
struct Sheet {
  glm::ivec3 origin, u, v;
  int cells_u, cells_v;
};

/// Distance by which a part of a lattice mesh is moved up when it is placed in space: none, the spacing of floats at
/// the far end of the whole mesh, or the spacing of doubles there.
enum class Lift { none, float_step, double_step };

/// A part under construction. Invariant: triangles index positions; within one stretch (see apart) equal places are one
/// position.
class LatticeMesh {
 public:
  std::uint32_t vertex(const glm::ivec3& place);
  /// Adds a new position, even if the place has one already.
  std::uint32_t new_vertex(const glm::ivec3& place);
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.push_back({a, b, c}); }
  /// Adds the cells for which keep(i, j) is true, row by row.
  template <typename Keep>
  void add_sheet(const Sheet& sheet, const Keep& keep) {
    for (int j = 0; j < sheet.cells_v; ++j) {
      for (int i = 0; i < sheet.cells_u; ++i) {
        if (keep(i, j)) add_cell(sheet, i, j);
      }
    }
  }
  void add_sheet(const Sheet& sheet);
  /// Adds a closed box of `cells` cells; its top comes first: see top().
  void add_box(const glm::ivec3& low, const glm::ivec3& cells);
  /// Adds a box without top and bottom (add_sides), or without its top (add_open_box).
  void add_sides(const glm::ivec3& low, const glm::ivec3& cells);
  void add_open_box(const glm::ivec3& low, const glm::ivec3& cells);

  /// Starts a new stretch: later triangles share no position with earlier ones.
  void apart() { numbers_.clear(); }
  /// Places all later triangles above their lattice place, by the smallest step of the kind `how`.
  void lift_from_here(Lift how);
  /// Gives every triangle its own positions.
  void separate();
  void turn(std::size_t triangle);

  std::vector<glm::ivec3> positions;
  std::vector<Triangle> triangles;
  bool signed_zeros = false;  ///< every other position's zeros become −0
  Lift lift = Lift::none;
  std::size_t lifted_from = std::numeric_limits<std::size_t>::max();

 private:
  struct Hash {
    std::size_t operator()(const glm::ivec3& place) const;
  };
  void add_cell(const Sheet& sheet, int i, int j);

  std::unordered_map<glm::ivec3, std::uint32_t, Hash> numbers_;
};

/// Adds a closed cube of s cells a side; `low` is its corner at the lowest coordinates, by default the lattice's zero.
inline void box(LatticeMesh& mesh, int s, const glm::ivec3& low) {
  mesh.add_box(low, {s, s, s});
}
inline void box(LatticeMesh& mesh, int s) {
  box(mesh, s, {0, 0, 0});
}

inline constexpr glm::ivec3 kX = {kCell, 0, 0}, kY = {0, kCell, 0}, kZ = {0, 0, kCell};

/// Returns the top of a cube of n cells at the lattice's zero. Its first row of cells lies along the cube's edge at x =
/// 0: the sides ab of those cells form that edge, and the other triangles at the edge belong to the side at −X.
inline Sheet top(int n) {
  return {n * kY, kZ, kX, n, n};
}

/// Diagnosis of a clean box with n cells an edge, and of a flat sheet of n² cells.
KnownDiagnosis known_box(std::uint64_t n);
KnownDiagnosis known_sheet(std::uint64_t n);
inline void open(KnownDiagnosis& known) {
  known.closed = known.closed_as_wound = false;
}
void add(KnownDiagnosis& sum, const KnownDiagnosis& part);

/// A builder of one defect, and the diagnosis that it must give: `size` is the number of cells along an edge.
struct Defect {
  std::string_view name, what;
  void (*build)(LatticeMesh& mesh, int size);
  KnownDiagnosis (*known)(std::uint64_t size);
};

std::span<const Defect> surface_defects();  ///< defects in the surface of a closed box
std::span<const Defect> sheet_defects();    ///< defects of open and doubled sheets and boxes, and of loose triangles
std::span<const Defect> joint_defects();    ///< defects of several parts that touch, overlap or cross

}  // namespace penumbra::mesh::broken
