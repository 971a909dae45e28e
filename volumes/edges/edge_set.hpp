// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/pages.hpp"
#include "mesh/triangle_soup.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// The edges of all casters in the form of device passes: each with the planes that determine its signed multiplicity
/// k_e(p).
namespace penumbra::volumes {

/// One of an edge's triangles, which contributes sgn(n · (p − anchor)) to k_e(p). All three edges of a triangle have
/// the same `anchor` and the same n up to its sign, so that p is on the same side of the triangle for all three,
/// regardless of the device's rounding.
struct EdgeSide {
  glm::vec3 n{0};  ///< not of unit length; 0: no triangle
  glm::vec3 anchor{0};
  std::uint32_t plane = visibility::SceneFloats::kNoPlane;  ///< SceneFloats::plane: the carrier's own plane contributes
                                                            ///< nothing
};

/// An edge with two of its triangles. An edge with n triangles has ⌈n / 2⌉ records, and its k_e is their sum.
struct EdgeRecord {
  glm::vec3 a{0}, b{0};
  std::array<EdgeSide, 2> sides;
  std::uint32_t cut = 0;  ///< index in CutEnds of its ends before rounding; 0: a and b are not rounded
};

/// The triangles that may cast shadows of a light.
struct EdgeCasters {
  std::vector<std::uint32_t> triangle;          ///< indices of the scene's triangles
  std::vector<std::uint32_t> largest_in_plane;  ///< for each SceneFloats::plane: the largest of these triangles
};
/// `light_index`: this light's own body is excluded; −1: nothing is.
EdgeCasters edge_casters(const visibility::SceneFloats& scene, std::int32_t light_index);

/// Returns the plane of one of the casters; in front of it, the triangle's sorted corners run counter-clockwise.
/// Exactly coplanar triangles take n and anchor from one of them, the largest: the edges between them are not among the
/// records, so p must be on the same side of all of them, regardless of the device's rounding.
EdgeSide plane_of(const visibility::SceneFloats& scene, const EdgeCasters& casters, std::uint32_t triangle);

/// All records whose k_e is not 0 everywhere. Each is computed on demand from stored edges and planes; a list of
/// records would take half a gigabyte for ten million edges.
class EdgeRecords {
 public:
  /// Treatment of edges whose k_e is 0 everywhere.
  enum class Flat : std::uint8_t {
    dropped,
    kept,  ///< stored separately, since they may not be flat in another frame
  };
  /// Both arguments must outlive this object. Records and their normals use only the scene.
  EdgeRecords(const visibility::SceneFloats& scene, const EdgeCasters& casters, Flat flat = Flat::dropped);

  enum class Followed : std::uint8_t {
    all,      ///< each record has the same edge as before; flat ones (is_flat()) contribute nothing now
    more,     ///< new records follow the old ones: edges that were flat, some of which may still be flat
    nothing,  ///< edges have changed: vertices were merged or separated, or casters differ. Earlier data is lost
  };
  /// Updates records made with Flat::kept to the next frame, in which vertices have moved. The adjacency of edges is
  /// checked, not recomputed.
  [[nodiscard]] Followed follow(const visibility::SceneFloats& scene, const EdgeCasters& casters);
  [[nodiscard]] bool is_flat(std::size_t record) const { return is_flat(pairs_[record]); }
  /// Returns, after follow(), whether any float of the record may have changed.
  [[nodiscard]] bool has_moved(std::size_t record) const { return has_moved(pairs_[record]); }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] EdgeRecord operator[](std::size_t record) const;
  [[nodiscard]] std::uint64_t memory_bytes() const {
    constexpr std::size_t kKept = sizeof(mesh::Triangle) + 9;  // bytes for each caster
    return planes_.size() * sizeof(EdgeSide) + pairs_.size() * sizeof(Pair) + kept_.casters.size() * kKept +
           kept_.places.size() * (sizeof(glm::vec3) + 4);
  }
  [[nodiscard]] visibility::Bounds box(std::size_t record) const;
  /// Returns the normals n of its sides.
  [[nodiscard]] std::array<glm::vec3, 2> normals(std::size_t record) const;
  /// Returns the scene index of one of its triangles.
  [[nodiscard]] std::uint32_t triangle(std::size_t record) const { return triangle_of(pairs_[record].sides[0]); }

 private:
  static constexpr std::uint32_t kReversed = 0x80000000u;  // bit in casters' indices: the winding runs from b to a
  static constexpr std::uint32_t kNoSide = 0xffffffffu;

  /// Two of an edge's triangles, or its last one.
  struct Pair {
    std::uint32_t a, b;                  // indices of positions
    std::array<std::uint32_t, 2> sides;  // indices of casters
  };
  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t side) const { return casters_->triangle[side & ~kReversed]; }
  [[nodiscard]] EdgeSide side(std::uint32_t of) const;
  [[nodiscard]] bool is_flat(const Pair& pair) const;
  [[nodiscard]] bool has_moved(const Pair& pair) const {
    const auto [first, second] = pair.sides;
    return kept_.moved[first & ~kReversed] != 0 || (second != kNoSide && kept_.moved[second & ~kReversed] != 0);
  }
  void find_planes();
  void find_pairs(std::span<const mesh::Triangle> triangles, Flat flat);
  [[nodiscard]] bool follow(Pair& pair, std::span<const std::uint32_t> vertex) const;
  void keep_places();
  [[nodiscard]] bool find_moved();

  const visibility::SceneFloats* scene_;
  const EdgeCasters* casters_;
  UnsetList<EdgeSide> planes_;  // for each caster (plane_of)
  UnsetList<Pair> pairs_;       // the records, then flat edges that are kept
  std::size_t size_ = 0;        // number of records
  /// Data of the last frame, for Flat::kept.
  struct Kept {
    std::vector<glm::vec3> places;
    std::vector<std::uint32_t> vertex;            // vertex of each position (mesh::merge_equal)
    std::vector<std::uint32_t> casters, largest;  // for each caster: its index, and the triangle that plane_of chose
    std::vector<mesh::Triangle> corners;          // for each caster
    std::vector<std::uint8_t> moved;              // for each caster: whether it or the triangle of its plane moved
  } kept_;
};

/// Returns all records as a list.
std::vector<EdgeRecord> edge_records(const visibility::SceneFloats& scene, const EdgeCasters& casters);

}  // namespace penumbra::volumes
