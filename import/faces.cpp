// SPDX-License-Identifier: Apache-2.0
// Triangulates a file's faces and counts changed and skipped ones.

#include "import/faces.hpp"

#include "base/error.hpp"
#include "import/polygon.hpp"

#include <glm/vec3.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace penumbra::import {

void FaceCollector::expect(std::uint64_t faces) {
  const std::size_t wanted = soup_.triangles.size() + faces;
  if (wanted <= soup_.triangles.capacity()) return;
  soup_.triangles.reserve(wanted);
  soup_.object.reserve(wanted);
  soup_.source_face.reserve(wanted);
}

void FaceCollector::add(std::span<const std::uint32_t> corners) {
  if (next_face_ == std::numeric_limits<std::uint32_t>::max()) throw InputError("more than 4,294,967,294 faces");
  const std::uint32_t face = next_face_++;
  if (corners.empty()) {
    ++empty_;
    return;
  }
  if (corners.size() < 3) {
    ++(corners.size() == 1 ? points_ : lines_);
    return;
  }
  const std::size_t first = soup_.triangles.size();
  due_ += corners.size() - 2;
  if (corners.size() == 3) {
    soup_.triangles.push_back({corners[0], corners[1], corners[2]});
  } else {
    std::vector<glm::dvec3> outline;
    for (const std::uint32_t corner : corners) outline.push_back(soup_.positions[corner]);
    const PolygonKind kind = triangulate_polygon(outline, soup_.triangles);
    ++(kind == PolygonKind::convex ? convex_ : kind == PolygonKind::concave ? concave_ : tangled_);
    for (std::size_t i = first; i < soup_.triangles.size(); ++i) {
      for (std::uint32_t& index : soup_.triangles[i]) index = corners[index];
    }
    polygon_triangles_ += soup_.triangles.size() - first;
  }
  for (std::size_t i = first; i < soup_.triangles.size(); ++i) {
    const auto& [a, b, c] = soup_.triangles[i];
    const auto at = [&](std::uint32_t index) -> const glm::dvec3& { return soup_.positions[index]; };
    if (at(a) == at(b) || at(b) == at(c) || at(c) == at(a)) ++collapsed_;
    soup_.object.push_back(0);
    soup_.source_face.push_back(face);
  }
}

void FaceCollector::require_all(std::uint64_t held, const std::string& file) const {
  if (next_face_ != held) {
    throw InputError("{}: it holds {} faces, but {} came through; the reader would lose some", file, held, next_face_);
  }
  if (soup_.triangles.size() != due_) {
    throw InputError("{}: its faces are made of {} triangles, but {} came through; the reader would lose some", file,
                     due_, soup_.triangles.size());
  }
}

std::vector<std::string> FaceCollector::notes() const {
  std::vector<std::string> notes;
  if (polygon_triangles_ > 0) {
    std::string note = fmt::format("{} polygons became {} triangles ({} convex, {} concave by ear clipping",
                                   convex_ + concave_ + tangled_, polygon_triangles_, convex_, concave_);
    if (tangled_ > 0)
      note += fmt::format(", {} that cross themselves or have no area: there, a fan was used where no ear was left",
                          tangled_);
    notes.push_back(note + ")");
  }
  if (points_ > 0) notes.push_back(fmt::format("{} points skipped: faces with one corner", points_));
  if (lines_ > 0) notes.push_back(fmt::format("{} lines skipped: faces with two corners", lines_));
  if (empty_ > 0) notes.push_back(fmt::format("{} faces without corners skipped", empty_));
  if (collapsed_ > 0)
    notes.push_back(fmt::format("{} triangles with two equal corners kept: they have no area", collapsed_));
  return notes;
}

std::string FaceCollector::instead_of_surfaces() const {
  return fmt::format("{} points, {} lines, {} faces without corners", points_, lines_, empty_);
}

void settle_unused_vertices(mesh::ImportedMesh& mesh, const std::function<void(std::uint32_t)>& refuse) {
  const auto is_finite = [](const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  auto& positions = mesh.soup.positions;
  std::vector<std::uint32_t> wild;
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    if (!is_finite(positions[v])) wild.push_back(v);
  }
  if (wild.empty()) return;
  for (const mesh::Triangle& triangle : mesh.soup.triangles) {
    for (const std::uint32_t v : triangle) {
      if (!is_finite(positions[v])) refuse(v);
    }
  }
  if (mesh.soup.triangles.empty()) return;
  for (const std::uint32_t v : wild) positions[v] = positions[mesh.soup.triangles.front().front()];
  mesh.notes.push_back(
      fmt::format("{} vertices are not finite, the first number {} (numbered from 0): ignored, since "
                  "no face uses them",
                  wild.size(), wild.front()));
}

}  // namespace penumbra::import
