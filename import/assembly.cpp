// SPDX-License-Identifier: Apache-2.0
// Places parts within parts. Parts are first sorted from the leaves up (Kahn 1962): a part that is left over contains
// itself, or a part that does. They are then placed from the roots down, by a stack in place of recursion.

#include "import/assembly.hpp"

#include "base/error.hpp"
#include "import/faces.hpp"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace penumbra::import {
namespace {

class Assembly {
 public:
  Assembly(std::span<const AssemblyPart> parts, const std::string& file)
      : parts_(parts), file_(file), faces_(mesh_.soup), filled_(parts.size(), false), placed_(parts.size(), false) {}

  mesh::ImportedMesh run(std::span<const PlacedPart> roots, const std::string& instead) {
    settle_order();
    if (std::ranges::find(filled_, true) == filled_.end()) refuse_nothing(instead);
    std::vector<PlacedPart> stack(roots.rbegin(), roots.rend());
    while (!stack.empty()) {  // no recursion: a file may nest a million parts
      const PlacedPart next = stack.back();
      stack.pop_back();
      add(next.part, next.placement);
      placed_[next.part] = true;
      const auto& children = parts_[next.part].children;
      for (std::size_t i = children.size(); i-- > 0;) {  // pushed last first, so that they are popped in the file's
                                                         // order
        if (filled_[children[i].part]) stack.push_back({children[i].part, next.placement * children[i].placement});
      }
    }
    faces_.require_all(held_, file_);
    if (mesh_.soup.triangles.empty()) refuse_nothing(instead);
    mesh_.notes = faces_.notes();
    settle_unused_vertices(mesh_, [&](std::uint32_t v) { refuse_vertex(v); });
    std::uint64_t unplaced = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) unplaced += !placed_[i] && has_faces(parts_[i]) ? 1 : 0;
    if (unplaced > 0) {
      mesh_.notes.push_back(fmt::format("{} of {} objects skipped: nothing places them", unplaced, parts_.size()));
    }
    if (mirrored_ > 0) {
      mesh_.notes.push_back(fmt::format(
          "{} objects mirrored by their transforms: windings reversed, so that the outside stays outside", mirrored_));
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse_nothing(const std::string& instead) const {
    throw InputError("{}: there are no triangles in it{}", file_, instead.empty() ? "" : " (" + instead + ")");
  }
  [[noreturn]] void refuse_vertex(std::uint32_t v) const {
    const Wild& wild = *std::ranges::find(wild_, v, &Wild::vertex);
    const glm::dvec3& p = mesh_.soup.positions[v];
    throw InputError("{}: {}: vertex {} is not finite where it is placed: ({}, {}, {})", file_, parts_[wild.part].name,
                     wild.number, p.x, p.y, p.z);
  }

  /// Removes parts whose children are all removed; a part that remains contains itself. A part is filled if it or one
  /// of its children has faces: other parts need no place, however often they are shown.
  void settle_order() {
    std::vector<std::size_t> waiting(parts_.size()), ready;
    std::vector<std::vector<std::size_t>> parents(parts_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      waiting[i] = parts_[i].children.size();
      if (waiting[i] == 0) ready.push_back(i);
      for (const PlacedPart& child : parts_[i].children) parents[child.part].push_back(i);
    }
    std::size_t gone = 0;
    while (!ready.empty()) {
      const std::size_t part = ready.back();
      ready.pop_back();
      ++gone;
      filled_[part] = filled_[part] || has_faces(parts_[part]);
      for (const std::size_t parent : parents[part]) {
        filled_[parent] = filled_[parent] || filled_[part];
        if (--waiting[parent] == 0) ready.push_back(parent);
      }
    }
    if (gone == parts_.size()) return;
    const auto left = std::ranges::find_if(waiting, [](std::size_t count) { return count > 0; });
    auto part = static_cast<std::size_t>(left - waiting.begin());
    std::vector<bool> seen(parts_.size(), false);
    while (!seen[part]) {  // the part may be above a cycle: walks down until a part repeats, which is in the cycle
      seen[part] = true;
      const auto& children = parts_[part].children;
      part = std::ranges::find_if(children, [&](const PlacedPart& child) { return waiting[child.part] > 0; })->part;
    }
    throw InputError("{}: {} is made of itself", file_, parts_[part].name);
  }

  static bool has_faces(const AssemblyPart& part) { return !part.triangles.empty() || !part.face_ends.empty(); }

  void add(std::size_t part_number, const glm::dmat4& placement) {
    const AssemblyPart& part = parts_[part_number];
    if (!has_faces(part)) return;
    held_ += part.triangles.size() + part.face_ends.size();
    auto& positions = mesh_.soup.positions;
    const std::size_t first = positions.size();
    if (first + part.positions.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw InputError("{}: more than 4,294,967,295 vertices, counting every copy of an object", file_);
    }
    for (std::size_t i = 0; i < part.positions.size(); ++i) {
      const glm::dvec3 p(placement * glm::dvec4(part.positions[i], 1));
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        // an error only if a face uses the vertex
        wild_.push_back({static_cast<std::uint32_t>(positions.size()), part_number, i});
      }
      positions.push_back(p);
    }
    const bool mirrored = glm::determinant(glm::dmat3(placement)) < 0;
    mirrored_ += mirrored ? 1 : 0;
    for (const mesh::Triangle& triangle : part.triangles) {
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) corners[i] = static_cast<std::uint32_t>(first) + triangle[i];
      if (mirrored) std::swap(corners[1], corners[2]);
      faces_.add(corners);
    }
    std::size_t begin = 0;
    for (const std::size_t end : part.face_ends) {
      std::vector<std::uint32_t> corners;
      for (std::size_t i = begin; i < end; ++i) corners.push_back(static_cast<std::uint32_t>(first) + part.corners[i]);
      if (mirrored) std::ranges::reverse(corners);
      faces_.add(corners);
      begin = end;
    }
  }

  std::span<const AssemblyPart> parts_;
  const std::string& file_;
  mesh::ImportedMesh mesh_;
  FaceCollector faces_;
  struct Wild {
    std::uint32_t vertex = 0;          ///< of the mesh
    std::size_t part = 0, number = 0;  ///< its origin in the file
  };
  std::vector<Wild> wild_;             ///< vertices with coordinates that are not finite
  std::vector<bool> filled_, placed_;  ///< for each part: whether it or a part below it has faces; whether it is placed
  std::uint64_t held_ = 0;             ///< faces of all parts, counted as often as the parts are placed
  std::uint64_t mirrored_ = 0;
};

}  // namespace

mesh::ImportedMesh assemble(std::span<const AssemblyPart> parts, std::span<const PlacedPart> roots,
                            const std::string& file, const std::string& instead) {
  return Assembly(parts, file).run(roots, instead);
}

}  // namespace penumbra::import
