// SPDX-License-Identifier: Apache-2.0
// Resolves self-intersections with CGAL's Polygon Mesh Processing, part by part.

#include "mesh/predicates.hpp"
#include "repair/cgal.hpp"

#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <deque>
#include <iterator>
#include <optional>
#include <utility>

namespace penumbra::repair {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Face = CgalMesh::Face_index;
using FacePair = std::pair<Face, Face>;

/// Distance by which CGAL may move the surface of a part, as a fraction of the diagonal of its bounds. Without a bound
/// it resolves more, but sometimes by cutting off whole limbs.
constexpr double kEnvelope = 0.01;

bool meet_elsewhere(const CgalMesh& mesh, const FacePair& pair) {
  std::array<CgalPoint, 3> p, q;
  std::ranges::transform(corners(mesh, pair.first), p.begin(), [&](auto v) { return mesh.point(v); });
  std::ranges::transform(corners(mesh, pair.second), q.begin(), [&](auto v) { return mesh.point(v); });
  // Moves common points to the front, in the same order.
  std::size_t common = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto same = std::find(q.begin() + static_cast<std::ptrdiff_t>(common), q.end(), p[i]);
    if (same == q.end()) continue;
    std::swap(q[common], *same);
    std::swap(p[common], p[i]);
    ++common;
  }
  using Segment = CgalKernel::Segment_3;
  using Triangle3 = CgalKernel::Triangle_3;
  switch (common) {
    case 0:
      return true;
    case 1:  // the triangles meet elsewhere only if the side opposite to the common point does
      return CGAL::do_intersect(Segment(p[1], p[2]), Triangle3(q[0], q[1], q[2])) ||
             CGAL::do_intersect(Segment(q[1], q[2]), Triangle3(p[0], p[1], p[2]));
    case 2:
      return CGAL::coplanar(p[0], p[1], p[2], q[2]) &&
             CGAL::coplanar_orientation(p[0], p[1], p[2], q[2]) == CGAL::POSITIVE;
    default:
      return false;  // the two sides of a plate
  }
}

double diagonal(const CgalMesh& mesh) {
  CGAL::Bbox_3 box;
  for (const auto v : mesh.vertices()) box += mesh.point(v).bbox();
  return glm::length(glm::dvec3(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin()));
}

/// Gives new faces the triangle of the nearest old face, through edges.
void name_new_faces(CgalSurface& surface) {
  std::deque<Face> queue;
  for (const Face face : surface.mesh.faces()) {
    if (surface.triangle[face] != CgalSurface::kNew) queue.push_back(face);
  }
  for (; !queue.empty(); queue.pop_front()) {
    for (const Face other : CGAL::faces_around_face(surface.mesh.halfedge(queue.front()), surface.mesh)) {
      if (other == CgalMesh::null_face() || surface.triangle[other] != CgalSurface::kNew) continue;
      surface.triangle[other] = surface.triangle[queue.front()];
      queue.push_back(other);
    }
  }
}

/// Returns the part with fewer intersections, or nullopt.
std::optional<CgalSurface> resolve(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles,
                                   std::size_t& resolved) {
  CgalSurface surface = to_cgal(soup, triangles);
  surface.mesh.collect_garbage();
  const std::size_t before = intersections(surface.mesh).size();
  pmp::experimental::remove_self_intersections(
      surface.mesh,
      CGAL::parameters::preserve_genus(false).polyhedral_envelope_epsilon(kEnvelope * diagonal(surface.mesh)));
  surface.mesh.collect_garbage();
  if (surface.mesh.number_of_faces() == 0) return std::nullopt;
  const std::size_t after = intersections(surface.mesh).size();
  if (after >= before) return std::nullopt;
  resolved = before - after;
  name_new_faces(surface);
  return surface;
}

void append(TriangleSoup& to, const TriangleSoup& from, const CgalSurface& surface, std::uint32_t first_triangle) {
  const auto offset = static_cast<std::uint32_t>(to.positions.size());
  for (const auto v : surface.mesh.vertices()) {
    const CgalPoint& p = surface.mesh.point(v);
    to.positions.emplace_back(p.x(), p.y(), p.z());
  }
  for (const Face face : surface.mesh.faces()) {
    const auto [a, b, c] = corners(surface.mesh, face);
    to.triangles.push_back({offset + a.idx(), offset + b.idx(), offset + c.idx()});
    const std::uint32_t named = surface.triangle[face];
    const std::uint32_t source = named == CgalSurface::kNew ? first_triangle : named;  // a part that was rebuilt
    to.object.push_back(from.object[source]);
    to.source_face.push_back(from.source_face[source]);
  }
}

}  // namespace

std::vector<FacePair> intersections(const CgalMesh& mesh) {
  std::vector<FacePair> pairs;
  pmp::self_intersections(mesh, std::back_inserter(pairs));
  std::erase_if(pairs, [&](const FacePair& pair) { return !meet_elsewhere(mesh, pair); });
  return pairs;
}

TriangleSoup resolve_intersections(const TriangleSoup& soup, RepairRecord& record) {
  const QuietCgal quiet;
  const CgalSurface whole = to_cgal(soup);
  const SurfaceParts parts = surface_parts(soup);
  std::vector<std::uint64_t> within(parts.triangles.size(), 0);
  std::uint64_t left = 0, failed = 0;
  for (const auto& [f, g] : intersections(whole.mesh)) {
    const std::uint32_t part = parts.of_triangle[whole.triangle[f]];
    if (part == parts.of_triangle[whole.triangle[g]]) ++within[part];
    ++left;
  }
  TriangleSoup repaired{soup.positions, {}, {}, {}};
  for (std::uint32_t part = 0; part < parts.triangles.size(); ++part) {
    std::optional<CgalSurface> better;
    std::size_t resolved = 0;
    if (within[part] > 0) {
      try {
        better = resolve(soup, parts.triangles[part], resolved);
      } catch (const std::exception&) {  // CGAL's assertions, for unforeseen input
        ++failed;
      }
    }
    if (better) {
      append(repaired, soup, *better, parts.triangles[part][0]);
      record[RepairKind::intersection] += resolved;
      continue;
    }
    for (const std::uint32_t t : parts.triangles[part]) {
      repaired.triangles.push_back(soup.triangles[t]);
      repaired.object.push_back(soup.object[t]);
      repaired.source_face.push_back(soup.source_face[t]);
    }
  }
  if (record[RepairKind::intersection] == 0 && left > 0) {
    record.left.push_back(fmt::format("{} pairs of triangles intersect still", left));
  }
  if (failed > 0) record.left.push_back(fmt::format("CGAL gave up on the intersections of {} parts", failed));
  return record[RepairKind::intersection] == 0 ? soup : without_unused_positions(repaired);
}

}  // namespace penumbra::repair
