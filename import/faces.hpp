#pragma once

#include "mesh/import.hpp"

#include <cstdint>
#include <functional>
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

  /// Faces that came, skipped or not.
  [[nodiscard]] std::uint64_t count() const { return next_face_; }
  /// Triangles that they are made of.
  [[nodiscard]] std::uint64_t triangles() const { return due_; }
  /// Throws InputError if it were not as many faces as the file holds, or if a face left fewer triangles than it is
  /// made of: what a reader loses is never lost in silence.
  void require_all(std::uint64_t held, const std::string& file) const;

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
  std::uint64_t due_ = 0;  ///< triangles that the faces are made of
  std::uint64_t empty_ = 0, points_ = 0, lines_ = 0, collapsed_ = 0;
};

/// Positions that are not finite are no matter where no triangle uses them: they are put where one is that is used, and
/// a note counts them. `refuse(vertex)` is called for the first that a triangle uses, and must throw.
void settle_unused_vertices(ImportedMesh& mesh, const std::function<void(std::uint32_t)>& refuse);

}  // namespace penumbra::mesh
