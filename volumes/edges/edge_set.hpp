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

/// The edges of everything that casts shadow, as device passes take them: each with the planes that its signed
/// multiplicity k_e(p) is made of.
namespace penumbra::volumes {

/// One of an edge's triangles: sgn(n · (p − anchor)) is what it adds to k_e(p). All three edges of a triangle have the
/// same `anchor` and the same n up to its sign, so that p is on one side of it for all three, however the device
/// rounds.
struct EdgeSide {
  glm::vec3 n{0};  ///< not of unit length; 0: no triangle
  glm::vec3 anchor{0};
  std::uint32_t plane = visibility::SceneFloats::kNoPlane;  ///< SceneFloats::plane: the carrier's own adds nothing
};

/// An edge with two of its triangles; an edge of n triangles is ⌈n / 2⌉ records: k_e is their sum.
struct EdgeRecord {
  glm::vec3 a{0}, b{0};
  std::array<EdgeSide, 2> sides;
  std::uint32_t cut = 0;  ///< CutEnds: the number of its ends as they are before rounding; 0: a and b are not rounded
};

/// The triangles that may shade a light.
struct EdgeCasters {
  std::vector<std::uint32_t> triangle;          ///< into the scene's
  std::vector<std::uint32_t> largest_in_plane;  ///< for each SceneFloats::plane: of these triangles, the largest
};
/// `light_index`: what is this light's own body is left out; −1: nothing is.
EdgeCasters edge_casters(const visibility::SceneFloats& scene, std::int32_t light_index);

/// The plane of one of the casters, in front where its sorted corners run counter-clockwise. Exactly coplanar triangles
/// take n and anchor from one of them, the largest: the edges between them are not among the records, so p must be on
/// one side of all of them, however the device rounds.
EdgeSide plane_of(const visibility::SceneFloats& scene, const EdgeCasters& casters, std::uint32_t triangle);

/// All records with k_e not 0 everywhere. Each is computed when it is asked for, from what is there once of edges and
/// planes; a list of them takes half a gigabyte for ten million edges.
class EdgeRecords {
 public:
  /// What becomes of edges with k_e 0 everywhere.
  enum class Flat : std::uint8_t {
    dropped,
    kept,  ///< aside: in another frame they may not be flat
  };
  /// Both must outlive it; records and their normals ask the scene alone.
  EdgeRecords(const visibility::SceneFloats& scene, const EdgeCasters& casters, Flat flat = Flat::dropped);

  enum class Followed : std::uint8_t {
    all,      ///< each record is of the same edge as before; those with is_flat() add nothing now
    more,     ///< after these there are others, which were flat, and some that still are
    nothing,  ///< other edges: vertices have met or parted, or others cast. What was known is lost
  };
  /// The records of the next frame, in which vertices have moved; of one made with Flat::kept. Who shares an edge with
  /// whom is checked, not found again.
  [[nodiscard]] Followed follow(const visibility::SceneFloats& scene, const EdgeCasters& casters);
  [[nodiscard]] bool is_flat(std::size_t record) const { return is_flat(pairs_[record]); }
  /// After follow: may any of its floats be another than before?
  [[nodiscard]] bool has_moved(std::size_t record) const { return has_moved(pairs_[record]); }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] EdgeRecord operator[](std::size_t record) const;
  [[nodiscard]] std::uint64_t memory_bytes() const {
    constexpr std::size_t kKept = sizeof(mesh::Triangle) + 9;  // of each caster
    return planes_.size() * sizeof(EdgeSide) + pairs_.size() * sizeof(Pair) + kept_.casters.size() * kKept +
           kept_.places.size() * (sizeof(glm::vec3) + 4);
  }
  [[nodiscard]] visibility::Bounds box(std::size_t record) const;
  /// n of its sides.
  [[nodiscard]] std::array<glm::vec3, 2> normals(std::size_t record) const;
  /// One of its triangles: the scene's number.
  [[nodiscard]] std::uint32_t triangle(std::size_t record) const { return triangle_of(pairs_[record].sides[0]); }

 private:
  static constexpr std::uint32_t kReversed = 0x80000000u;  // of casters' numbers: the winding runs from b to a
  static constexpr std::uint32_t kNoSide = 0xffffffffu;

  /// Two of an edge's triangles, or its last.
  struct Pair {
    std::uint32_t a, b;                  // positions
    std::array<std::uint32_t, 2> sides;  // casters
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
  UnsetList<EdgeSide> planes_;  // of each caster (plane_of)
  UnsetList<Pair> pairs_;       // the records, then what is flat and kept
  std::size_t size_ = 0;        // records
  /// With Flat::kept, as the last frame had it.
  struct Kept {
    std::vector<glm::vec3> places;
    std::vector<std::uint32_t> vertex;            // mesh::merge_equal
    std::vector<std::uint32_t> casters, largest;  // of each caster: its number, and plane_of's choice
    std::vector<mesh::Triangle> corners;          // of each caster
    std::vector<std::uint8_t> moved;              // of each caster: itself, or what its plane is that of
  } kept_;
};

/// All of them at once.
std::vector<EdgeRecord> edge_records(const visibility::SceneFloats& scene, const EdgeCasters& casters);

}  // namespace penumbra::volumes
