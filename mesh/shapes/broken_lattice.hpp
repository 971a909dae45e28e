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

/// Internal to this room: the parts that broken meshes are made of, on a lattice of integers.
namespace penumbra::mesh::broken {

inline constexpr int kCell = 2048;  ///< lattice steps along a cell: a needle one step high is below kNeedle

/// A flat sheet of cells_u × cells_v cells that faces u × v. Cell (i, j) has the corners a = origin + i·u + j·v,
/// b = a + u, c = a + u + v, d = a + v and the triangles abc, acd.
struct Sheet {
  glm::ivec3 origin, u, v;
  int cells_u, cells_v;
};

/// How far a part of a lattice mesh is moved up when it is placed in space: not at all, by the spacing of floats at the
/// far end of the whole, by the spacing of doubles there.
enum class Lift { none, float_step, double_step };

/// A part under construction. Invariant: triangles index positions; within one stretch (see apart) equal places are
/// one position.
class LatticeMesh {
 public:
  std::uint32_t vertex(const glm::ivec3& place);
  /// A position of its own, whatever is there already.
  std::uint32_t new_vertex(const glm::ivec3& place);
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.push_back({a, b, c}); }
  /// Those cells for which keep(i, j), row by row.
  template <typename Keep>
  void add_sheet(const Sheet& sheet, const Keep& keep) {
    for (int j = 0; j < sheet.cells_v; ++j) {
      for (int i = 0; i < sheet.cells_u; ++i) {
        if (keep(i, j)) add_cell(sheet, i, j);
      }
    }
  }
  void add_sheet(const Sheet& sheet);
  /// A closed box of `cells` cells; its top comes first: see top().
  void add_box(const glm::ivec3& low, const glm::ivec3& cells);
  /// A box without top and bottom; without its top.
  void add_sides(const glm::ivec3& low, const glm::ivec3& cells);
  void add_open_box(const glm::ivec3& low, const glm::ivec3& cells);

  /// What is added from here on shares no position with what is there.
  void apart() { numbers_.clear(); }
  /// What is added from here on will stand the smallest step above where it is put.
  void lift_from_here(Lift how);
  /// Gives every triangle positions of its own.
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

/// A closed cube of s cells a side; `low` is its corner at the lowest coordinates, by default the lattice's zero.
inline void box(LatticeMesh& mesh, int s, const glm::ivec3& low) {
  mesh.add_box(low, {s, s, s});
}
inline void box(LatticeMesh& mesh, int s) {
  box(mesh, s, {0, 0, 0});
}

inline constexpr glm::ivec3 kX = {kCell, 0, 0}, kY = {0, kCell, 0}, kZ = {0, 0, kCell};

/// The top of a cube of n cells at the lattice's zero. Its first row of cells lies along the cube's edge at x = 0: the
/// sides ab of those cells are the edge, and the other triangles on it belong to the side at −X.
inline Sheet top(int n) {
  return {n * kY, kZ, kX, n, n};
}

/// Of a clean box of n³ cells, and of a flat sheet of n² cells.
KnownDiagnosis known_box(std::uint64_t n);
KnownDiagnosis known_sheet(std::uint64_t n);
inline void open(KnownDiagnosis& known) {
  known.closed = known.closed_as_wound = false;
}
void add(KnownDiagnosis& sum, const KnownDiagnosis& part);

/// How to make one defect, and what there is then to find: `size` is the number of cells along an edge.
struct Defect {
  std::string_view name, what;
  void (*build)(LatticeMesh& mesh, int size);
  KnownDiagnosis (*known)(std::uint64_t size);
};

std::span<const Defect> surface_defects();  ///< in the surface of a closed box
std::span<const Defect> sheet_defects();    ///< of open and doubled sheets, and of vertices as numbers
std::span<const Defect> joint_defects();    ///< of several parts that touch, overlap or cross

}  // namespace penumbra::mesh::broken
