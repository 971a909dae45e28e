// SPDX-License-Identifier: Apache-2.0
// Penumbra wedges of Akenine-Möller and Assarsson 2002 (wedge-ramp), with shared sides, and their ramps in double.

#include "volumes/soft/ramp_wedges.hpp"

#include "base/parallel.hpp"
#include "visibility/pair_truth.hpp"
#include "volumes/wedges/light_hull.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>
#include <utility>

namespace penumbra::volumes {
namespace {

/// The cosine of the sharpest turn that is bisected: slightly more than a right angle. Silhouettes of fine meshes run
/// back and forth. If such sharp turns were bisected, the wedges of edges that run back would lie on the other side,
/// and would not cancel.
constexpr double kSharpest = -0.1;

Plane plane_through(const glm::dvec3& at, const glm::dvec3& normal) {
  const glm::dvec3 n = glm::normalize(normal);
  return {n.x, n.y, n.z, -glm::dot(n, at)};
}

double height(const Plane& plane, const glm::dvec3& p) {
  return glm::dot(plane.normal(), p) + plane.d;
}

/// Returns an upper bound of the rounding errors of p's heights over front and back: products of numbers as large as
/// |p| and |a|, with planes whose normals are off by a few units in the last place.
double height_error(const Wedge& wedge, const glm::vec3& p) {
  return 0x1p-45 * (glm::length(glm::dvec3(p)) + glm::length(wedge.a) + glm::length(wedge.b));
}

/// The end of an edge, with a key by which equal ends sort together.
struct End {
  glm::vec3 at{0};
  std::size_t edge = 0;

  [[nodiscard]] std::tuple<float, float, float> key() const { return {at.x, at.y, at.z}; }
};

class Builder {
 public:
  Builder(const LightVolumes& volumes, const visibility::Light& light)
      : volumes_(volumes), hull_(light_hull(light)), center_(volumes.l) {
    for (std::size_t i = 0; i < volumes.edges.size(); ++i) {
      ends_.push_back({volumes.edges[i].a, i});
      ends_.push_back({volumes.edges[i].b, i});
    }
    std::ranges::sort(
        ends_, [](const End& x, const End& y) { return std::pair(x.key(), x.edge) < std::pair(y.key(), y.edge); });
  }

  [[nodiscard]] Wedge build(std::size_t edge) const {
    const VolumeEdge& e = volumes_.edges[edge];
    Wedge wedge{e.a, e.b, WedgeOutcome::empty, {}, std::nullopt, static_cast<std::uint32_t>(edge)};
    const glm::dvec3 normal = lit_side(e) * (e.multiplicity > 0 ? 1.0 : -1.0);
    const std::optional<Plane> front = tangent(wedge, normal), back = tangent(wedge, -normal);
    if (!front || !back) return wedge;
    wedge.planes = {*front, *back, side(edge, e.a, e.b), side(edge, e.b, e.a)};
    wedge.outcome = WedgeOutcome::wedge;
    return wedge;
  }

 private:
  /// Returns the unit normal of (c, a, b) toward the side on which the edge's triangles do not hide the light.
  [[nodiscard]] glm::dvec3 lit_side(const VolumeEdge& e) const {
    const glm::dvec3 n = glm::cross(glm::dvec3(e.a) - center_, glm::dvec3(e.b) - center_);
    const double length = glm::length(n);
    if (!(length > 0)) return glm::dvec3(0);
    return n / (e.multiplicity > 0 ? length : -length);
  }

  /// Returns the plane through the edge that touches the light and has all of it behind. This plane bounds the wedge on
  /// the side of (c, a, b) that `normal` points to: from points beyond it, the light appears past the edge, on the
  /// edge's other side. Returns nullopt if there is no such plane.
  [[nodiscard]] std::optional<Plane> tangent(const Wedge& wedge, const glm::dvec3& normal) const {
    const glm::dvec3 away = 0.5 * (wedge.a + wedge.b) - center_;
    for (const glm::dvec3& touched : hull_.corners) {
      if (!(glm::dot(normal, touched - center_) < 0)) continue;
      const glm::dvec3 n = glm::cross(wedge.b - wedge.a, touched - wedge.a);
      const double direction = glm::dot(n, away);
      if (direction == 0) continue;
      const Plane plane = plane_through(wedge.a, direction > 0 ? n : -n);
      const bool behind = std::ranges::all_of(hull_.corners, [&](const glm::dvec3& l) {
        return height(plane, l) <= 0x1p-40 * (glm::length(l) + glm::length(wedge.a));
      });
      if (behind) return plane;
    }
    return std::nullopt;
  }

  /// Returns a plane that contains c and the end, with the other end on its positive side.
  [[nodiscard]] Plane side(std::size_t edge, const glm::vec3& end, const glm::vec3& other) const {
    const glm::dvec3 own = lit_side(volumes_.edges[edge]), spoke = glm::dvec3(end) - center_;
    glm::dvec3 along = own;
    if (const std::optional<std::size_t> next = neighbour(edge, end)) {
      const glm::dvec3 theirs = lit_side(volumes_.edges[*next]);
      if (glm::dot(own, theirs) > kSharpest) along = own + theirs;
    }
    const glm::dvec3 normal = glm::cross(spoke, along);
    const Plane plane = plane_through(center_, normal);
    if (height(plane, glm::dvec3(other)) >= 0) return plane;
    return {-plane.a, -plane.b, -plane.c, -plane.d};
  }

  /// Returns the only other silhouette edge at this end, if there is exactly one with equal |k|.
  [[nodiscard]] std::optional<std::size_t> neighbour(std::size_t edge, const glm::vec3& end) const {
    const auto key = End{end, 0}.key();
    const auto first = std::ranges::lower_bound(ends_, key, {}, &End::key);
    const auto last = std::ranges::upper_bound(ends_, key, {}, &End::key);
    if (last - first != 2) return std::nullopt;
    const std::size_t next = first->edge == edge ? (first + 1)->edge : first->edge;
    if (std::abs(volumes_.edges[next].multiplicity) != std::abs(volumes_.edges[edge].multiplicity)) return std::nullopt;
    return next;
  }

  const LightVolumes& volumes_;
  LightHull hull_;
  glm::dvec3 center_;
  std::vector<End> ends_;
};

}  // namespace

LightWedges ramp_wedges_of(const LightVolumes& volumes, const visibility::Light& light) {
  const Builder builder(volumes, light);
  LightWedges result{volumes.edges, std::vector<Wedge>(volumes.edges.size())};
  for_each_index(result.wedges.size(), [&](std::size_t i) { result.wedges[i] = builder.build(i); });
  return result;
}

double ramp_sum(const LightWedges& wedges, const visibility::Light& light, const glm::vec3& p) {
  double sum = 0;
  const glm::vec3 c = visibility::center_of(light);
  for (std::size_t i = 0; i < wedges.edges.size(); ++i) {
    const Wedge& wedge = wedges.wedges[i];
    if (wedge.outcome != WedgeOutcome::wedge) continue;
    std::array<double, kRampPlanes> at{};
    for (std::size_t k = 0; k < kRampPlanes; ++k) at[k] = height(wedge.planes[k], glm::dvec3(p));
    if (std::ranges::any_of(at, [](double h) { return h < 0; })) continue;
    const VolumeEdge& edge = wedges.edges[i];
    const bool lit = visibility::edge_side(p, c, edge.a, edge.b, light) < 0;
    // On the edge, where front and back meet, the wedge has no width: the shadow is hard there.
    if (!(at[kFront] + at[kBack] > height_error(wedge, p))) continue;
    const double ramp = at[kFront] / (at[kFront] + at[kBack]);
    sum += edge.multiplicity * (lit ? ramp : ramp - 1);
  }
  return sum;
}

std::vector<double> ramp_words(const LightWedges& wedges) {
  std::vector<double> words(wedges.edges.size() * kRampPlanes * 4);
  for (std::size_t i = 0; i < wedges.edges.size(); ++i) {
    if (wedges.wedges[i].outcome != WedgeOutcome::wedge) continue;
    for (std::size_t k = 0; k < kRampPlanes; ++k) {
      const Plane& plane = wedges.wedges[i].planes[k];
      const std::array<double, 4> numbers{plane.a, plane.b, plane.c, plane.d};
      std::ranges::copy(numbers, &words[(i * kRampPlanes + k) * 4]);
    }
  }
  return words;
}

}  // namespace penumbra::volumes
