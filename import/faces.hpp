#pragma once

#include "mesh/import.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace penumbra::mesh {

/// Turns a file's faces into the triangles of a soup, and counts what it had to change or skip. Every face gets the
/// next number as its `source_face`, skipped or not.
class FaceCollector {
 public:
  explicit FaceCollector(TriangleSoup& soup) : soup_(soup) {}

  /// So many more faces may come.
  void expect(std::uint64_t faces);

  /// Adds a face with the given corners: indices into the soup's positions, in range.
  void add(std::span<const std::uint32_t> corners);

  /// Counts what the file lists apart from its faces; these get no number.
  void skip_points(std::uint64_t count) { points_ += count; }
  void skip_lines(std::uint64_t count) { lines_ += count; }

  /// One note for each kind of thing that happened.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// What was in the file in place of surfaces ("12 points, 3 lines"), for the message that there are none.
  [[nodiscard]] std::string instead_of_surfaces() const;

 private:
  TriangleSoup& soup_;
  std::uint32_t next_face_ = 0;
  std::uint64_t convex_ = 0, concave_ = 0, tangled_ = 0, polygon_triangles_ = 0;
  std::uint64_t empty_ = 0, points_ = 0, lines_ = 0, collapsed_ = 0;
};

}  // namespace penumbra::mesh
