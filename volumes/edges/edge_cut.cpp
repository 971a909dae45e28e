// SPDX-License-Identifier: Apache-2.0
// Cuts edge records at a light's plane, and finds the edges that cut triangles have in the plane
// (docs/signed-crossings.md, cut edges).

#include "volumes/edges/edge_cut.hpp"

#include "mesh/predicates.hpp"
#include "volumes/edges/cut_ends.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::SceneFloats;

/// Returns the point where the edge a b crosses the side's plane. The result is the same for (b, a).
glm::vec3 cut(const LightSide& side, const glm::vec3& a, const glm::vec3& b) {
  const glm::dvec3 n = glm::cross(side.u, side.v);
  glm::dvec3 from(side.stored(a)), to(side.stored(b));
  double h0 = glm::dot(n, from - side.center), h1 = glm::dot(n, to - side.center);
  if (std::abs(h1) < std::abs(h0)) {
    std::swap(from, to);
    std::swap(h0, h1);
  }
  // Rounded heights close to 0 may have equal signs where the exact ones differ.
  return glm::vec3(h0 == h1 ? from : from + (to - from) * std::clamp(h0 / (h0 - h1), 0.0, 1.0));
}

/// Returns whether the segment a b in the light's plane may touch the light, enlarged by an eighth.
bool may_touch_light(const LightSide& side, const glm::vec3& a, const glm::vec3& b) {
  const auto at = [&](const glm::vec3& x) {
    const glm::dvec3 d = glm::dvec3(x) - side.center;
    const double uu = glm::dot(side.u, side.u), vv = glm::dot(side.v, side.v), uv = glm::dot(side.u, side.v);
    const double du = glm::dot(d, side.u), dv = glm::dot(d, side.v), det = uu * vv - uv * uv;
    return std::pair((du * vv - dv * uv) / det, (dv * uu - du * uv) / det);
  };
  const auto [s0, t0] = at(a);
  const auto [s1, t1] = at(b);
  constexpr double kAround = 1.125;
  return std::min(s0, s1) <= kAround && std::max(s0, s1) >= -kAround && std::min(t0, t1) <= kAround &&
         std::max(t0, t1) >= -kAround;
}

}  // namespace

int LightSide::place_of(const glm::vec3& x) const {
  return static_cast<int>(mesh::side_of_plane(plane[0], plane[1], plane[2], glm::dvec3(stored(x)))) *
         (sign < 0 ? -1 : 1);
}

bool reaches_behind(const SceneFloats& scene, const LightSide& side) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 x((corner & 1) != 0 ? scene.upper.x : scene.lower.x,
                      (corner & 2) != 0 ? scene.upper.y : scene.lower.y,
                      (corner & 4) != 0 ? scene.upper.z : scene.lower.z);
    if (side.place_of(x) <= 0) return true;
  }
  return false;
}

bool keep_in_front(EdgeRecord& record, const LightSide& side, CutEnds* ends) {
  const int at_a = side.place_of(record.a), at_b = side.place_of(record.b);
  if (at_a <= 0 && at_b <= 0) return false;
  if (at_a > 0 && at_b > 0) return true;
  if (ends != nullptr) {
    // An end in the plane is cut as well: edges in the plane begin there, and rounding must not move it.
    record.cut = ends->of_edge(record.a, record.b, at_a <= 0);
  } else if (at_a < 0 || at_b < 0) {
    (at_a < 0 ? record.a : record.b) = cut(side, record.a, record.b);
  }
  return true;
}

std::vector<EdgeRecord> edges_in_plane(const SceneFloats& scene, const EdgeCasters& casters,
                                       std::span<const std::uint32_t> triangles, const LightSide& side, CutEnds* ends) {
  std::vector<EdgeRecord> records;
  using Crossing = CutEnds::Crossing;
  const auto rounded = [&](const Crossing& at) { return at.a == at.b ? at.a : cut(side, at.a, at.b); };
  for (const std::uint32_t triangle : triangles) {
    const std::array<glm::vec3, 3> corners = scene.corners(triangle);
    // Walks around the triangle to find the points where its boundary leaves the front, and where it returns.
    std::optional<Crossing> leaves, returns;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec3 &a = corners[i], &b = corners[(i + 1) % 3];
      const int from = side.place_of(a), to = side.place_of(b);
      if (from > 0 && to <= 0) leaves = to == 0 ? Crossing{b, b} : Crossing{a, b};
      if (from <= 0 && to > 0) returns = from == 0 ? Crossing{a, a} : Crossing{a, b};
    }
    if (!leaves || !returns) continue;
    // The record is oriented like the corners: in front where those run counter-clockwise.
    EdgeRecord record{{}, {}, {plane_of(scene, casters, triangle), EdgeSide{}}};
    if (ends != nullptr) {
      record.cut = ends->in_plane(*leaves, *returns);
      if (record.cut == 0) continue;
      record.a = ends->rounded((*ends)[record.cut].a);
      record.b = ends->rounded((*ends)[record.cut].b);
    } else {
      record.a = rounded(*leaves);
      record.b = rounded(*returns);
      if (record.a == record.b || !may_touch_light(side, record.a, record.b)) continue;
    }
    records.push_back(record);
  }
  return records;
}

std::vector<EdgeRecord> cut_records(const SceneFloats& scene, const EdgeCasters& casters, const LightSide& side) {
  std::vector<EdgeRecord> records = edges_in_plane(scene, casters, casters.triangle, side);
  for (EdgeRecord& record : edge_records(scene, casters)) {
    if (keep_in_front(record, side)) records.push_back(record);
  }
  return records;
}

}  // namespace penumbra::volumes
