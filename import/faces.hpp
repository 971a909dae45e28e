// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/import.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace penumbra::import {

/// Turns a file's faces into the triangles of a soup, and counts changed and skipped faces. Every face gets the next
/// number as its `source_face`, skipped or not.
class FaceCollector {
 public:
  explicit FaceCollector(mesh::TriangleSoup& soup) : soup_(soup) {}

  /// Announces `faces` more faces, to reserve memory.
  void expect(std::uint64_t faces);

  /// Adds a face with the given corners: indices into the soup's positions, in range.
  void add(std::span<const std::uint32_t> corners);

  /// Returns the number of faces added, skipped or not.
  [[nodiscard]] std::uint64_t count() const { return next_face_; }
  /// Returns the number of triangles that the added faces consist of.
  [[nodiscard]] std::uint64_t triangles() const { return due_; }
  /// Throws InputError if the number of faces added is not `held`, the number in the file, or if a face gave fewer
  /// triangles than it consists of, so that a reader never loses faces silently.
  void require_all(std::uint64_t held, const std::string& file) const;

  /// Counts elements that the file lists apart from its faces; these get no number.
  void skip_points(std::uint64_t count) { points_ += count; }
  void skip_lines(std::uint64_t count) { lines_ += count; }

  /// Returns one note for each kind of change.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// Describes the file's content other than surfaces ("12 points, 3 lines"), for the message that the file has no
  /// surfaces.
  [[nodiscard]] std::string instead_of_surfaces() const;

 private:
  mesh::TriangleSoup& soup_;
  std::uint32_t next_face_ = 0;
  std::uint64_t convex_ = 0, concave_ = 0, tangled_ = 0, polygon_triangles_ = 0;
  std::uint64_t due_ = 0;  ///< triangles that the faces consist of
  std::uint64_t empty_ = 0, points_ = 0, lines_ = 0, collapsed_ = 0;
};

/// Moves positions that are not finite and that no triangle uses to a used position, and counts them in a note. Calls
/// `refuse(vertex)`, which must throw, for the first such position that a triangle uses.
void settle_unused_vertices(mesh::ImportedMesh& mesh, const std::function<void(std::uint32_t)>& refuse);

}  // namespace penumbra::import
