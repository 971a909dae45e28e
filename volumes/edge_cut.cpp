#include "volumes/edge_cut.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::SceneFloats;

/// Where the edge a b passes through the side's plane. The same for (b, a).
glm::vec3 cut(const LightSide& side, const glm::vec3& a, const glm::vec3& b) {
  const glm::dvec3 n = glm::cross(side.u, side.v);
  glm::dvec3 from(side.stored(a)), to(side.stored(b));
  double h0 = glm::dot(n, from - side.center), h1 = glm::dot(n, to - side.center);
  if (std::abs(h1) < std::abs(h0)) {
    std::swap(from, to);
    std::swap(h0, h1);
  }
  return glm::vec3(h0 == h1 ? from : from + (to - from) * (h0 / (h0 - h1)));
}

/// May the segment a b in the light's plane touch the light? With an eighth of the light around it.
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

double LightSide::height_of(const glm::vec3& x) const {
  return sign * glm::dot(glm::cross(u, v), glm::dvec3(stored(x)) - center);
}

bool reaches_behind(const SceneFloats& scene, const LightSide& side) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 x((corner & 1) != 0 ? scene.upper.x : scene.lower.x,
                      (corner & 2) != 0 ? scene.upper.y : scene.lower.y,
                      (corner & 4) != 0 ? scene.upper.z : scene.lower.z);
    if (side.height_of(x) <= 0) return true;
  }
  return false;
}

bool keep_in_front(EdgeRecord& record, const LightSide& side) {
  const double ha = side.height_of(record.a), hb = side.height_of(record.b);
  if (ha <= 0 && hb <= 0) return false;
  const glm::vec3 x = ha < 0 || hb < 0 ? cut(side, record.a, record.b) : record.a;
  if (ha < 0) record.a = x;
  if (hb < 0) record.b = x;
  return true;
}

std::vector<EdgeRecord> edges_in_plane(const SceneFloats& scene, const EdgeCasters& casters,
                                       std::span<const std::uint32_t> triangles, const LightSide& side) {
  std::vector<EdgeRecord> records;
  for (const std::uint32_t triangle : triangles) {
    const std::array<glm::vec3, 3> corners = scene.corners(triangle);
    // Around the triangle: where it leaves the front, and where it comes back.
    std::optional<glm::vec3> leaves, returns;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec3 &a = corners[i], &b = corners[(i + 1) % 3];
      const bool from = side.height_of(a) > 0, to = side.height_of(b) > 0;
      if (from && !to) leaves = side.height_of(b) == 0 ? b : cut(side, a, b);
      if (!from && to) returns = side.height_of(a) == 0 ? a : cut(side, a, b);
    }
    if (!leaves || !returns || *leaves == *returns || !may_touch_light(side, *leaves, *returns)) continue;
    // Run around as the corners do: in front where those are counter-clockwise.
    records.push_back({*leaves, *returns, {plane_of(scene, casters, triangle), EdgeSide{}}});
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
