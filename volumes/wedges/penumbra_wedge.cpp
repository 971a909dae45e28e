// SPDX-License-Identifier: Apache-2.0
// Constructs penumbra wedges: `original` after Assarsson and Akenine-Möller 2003 (with splits where the paper's planes
// do not exist), `tight` as the facets of the convex hull of the penumbra (not from a paper). Departs from the paper:
// every plane is checked by exact signs and rounded outward.

#include "volumes/wedges/penumbra_wedge.hpp"

#include "base/parallel.hpp"
#include "mesh/predicates.hpp"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::volumes {
namespace {

constexpr int kMostSplits = 5;  // an edge becomes at most 2⁵ pieces

void add(std::vector<Plane>& planes, const std::optional<Plane>& plane) {
  if (plane) planes.push_back(*plane);
}

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

// ---- tight

/// Returns two directions at right angles to n (and to each other), so that (s, t, n) is right-handed.
std::array<glm::dvec3, 2> across(const glm::dvec3& n) {
  const glm::dvec3 size = glm::abs(n);
  const glm::dvec3 axis = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                          : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                               : glm::dvec3(0, 0, 1);
  const glm::dvec3 s = glm::normalize(glm::cross(axis, n));
  return {s, glm::normalize(glm::cross(n, s))};
}

/// Returns the extreme rays of the cone of all x − l, counter-clockwise with m pointing at the viewer. Two rays for a
/// flat cone.
std::vector<glm::dvec3> extreme_rays(const EdgeAndLight& cast, const glm::dvec3& m) {
  struct Ray {
    glm::dvec2 at;  // intersection of the ray with the plane m · v = 1
    glm::dvec3 v;
  };
  const auto [s, t] = across(m);
  std::vector<Ray> rays;
  for (const glm::dvec3& l : cast.light) {
    for (const glm::dvec3& x : {cast.a, cast.b}) {
      const glm::dvec3 v = x - l;
      rays.push_back({glm::dvec2(glm::dot(v, s), glm::dot(v, t)) / glm::dot(v, m), v});
    }
  }
  std::ranges::sort(rays,
                    [](const Ray& a, const Ray& b) { return a.at.x != b.at.x ? a.at.x < b.at.x : a.at.y < b.at.y; });
  // Andrew's monotone chain: the lower half from left to right, then the upper half from right to left. Rounding may
  // keep a ray that is not quite extreme, or lose one that is barely extreme: bounding_plane corrects or drops the
  // resulting plane.
  std::vector<Ray> hull;
  const auto extend = [&](const Ray& ray, std::size_t floor) {
    while (hull.size() >= floor + 2 && cross(hull.back().at - hull[hull.size() - 2].at, ray.at - hull.back().at) <= 0) {
      hull.pop_back();
    }
    hull.push_back(ray);
  };
  for (const Ray& ray : rays) extend(ray, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = rays.size() - 1; i-- > 0;) extend(rays[i], lower);
  hull.pop_back();
  std::vector<glm::dvec3> extreme;
  for (const Ray& ray : hull) extreme.push_back(ray.v);
  return extreme;
}

/// Returns the facets of the convex hull of the penumbra, e + C with C the cone of all x − l. The normals of C's facets
/// (the extreme rays of C's dual) are normals of the hull where they stay extreme for the sum; each such facet touches
/// e at one end. Where two neighbouring facets touch different ends, there is one more between them: its normal is at
/// right angles to e, and it touches all of e.
std::vector<Plane> tight_planes(const EdgeAndLight& cast, const glm::dvec3& m) {
  const std::vector<glm::dvec3> rays = extreme_rays(cast, m);
  const std::size_t count = rays.size();
  if (count < 2) return {};
  const glm::dvec3 edge = cast.b - cast.a;
  std::vector<glm::dvec3> normals(count);
  for (std::size_t i = 0; i < count; ++i) normals[i] = glm::normalize(glm::cross(rays[i], rays[(i + 1) % count]));
  std::vector<Plane> planes;
  for (const glm::dvec3& normal : normals) add(planes, bounding_plane(normal, cast, m));
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 &before = normals[(i + count - 1) % count], &after = normals[i];
    if (count == 2) {  // a flat cone: its two boundary rays in its own plane
      const glm::dvec3 end = glm::cross(normals[0], rays[i]);
      add(planes, bounding_plane(glm::dot(end, rays[1 - i]) > 0 ? end : -end, cast, m));
    } else if (glm::dot(before, edge) * glm::dot(after, edge) < 0) {
      const glm::dvec3 between = glm::cross(edge, rays[i]);
      add(planes, bounding_plane(glm::dot(between, before + after) > 0 ? between : -between, cast, m));
    }
  }
  return planes;
}

// ---- original

/// Returns the normal of the plane that contains `at`, `direction` and a corner of the light, and has the whole light
/// on its negative side: the corner is the one that leaves no other corner beyond. The sign of `turn` selects one of
/// the two tangents.
std::optional<glm::dvec3> tangent_normal(const glm::dvec3& at, const glm::dvec3& direction,
                                         std::span<const glm::dvec3> light, double turn) {
  // Seen along `direction`, the light is a fan of directions from `at`; a tangent is the fan's first or last direction.
  std::optional<glm::dvec3> extreme;
  for (const glm::dvec3& l : light) {
    const glm::dvec3 normal = turn * glm::cross(direction, l - at);
    if (!(glm::dot(normal, normal) > 0)) return std::nullopt;
    if (!extreme || glm::dot(*extreme, l - at) > 0) extreme = normal;
  }
  for (const glm::dvec3& l : light) {
    const double beyond = glm::dot(*extreme, l - at);
    if (beyond > 0x1p-30 * glm::length(*extreme) * glm::length(l - at)) return std::nullopt;
  }
  return extreme;
}

/// Returns the edge with its farther end moved towards the light's centre, so that both ends are equally far from the
/// centre.
std::array<glm::dvec3, 2> evened(const EdgeAndLight& cast, const glm::dvec3& center) {
  const double to_a = glm::length(cast.a - center), to_b = glm::length(cast.b - center), near = std::min(to_a, to_b);
  return {to_a > near ? center + (cast.a - center) * (near / to_a) : cast.a,
          to_b > near ? center + (cast.b - center) * (near / to_b) : cast.b};
}

/// Returns an empty list if the front or back plane does not exist (the moved edge's line meets the light). A side
/// plane that does not exist is left out, which only loosens the bound.
std::vector<Plane> original_planes(const EdgeAndLight& cast, const glm::dvec3& center, const glm::dvec3& m) {
  const auto [a, b] = evened(cast, center);
  const glm::dvec3 edge = b - a;
  std::vector<Plane> planes;
  for (const double turn : {1.0, -1.0}) {
    const auto normal = tangent_normal(a, edge, cast.light, turn);
    if (normal) add(planes, bounding_plane(*normal, cast, m, a));
  }
  if (planes.size() < 2) return {};
  const std::array<glm::dvec3, 2> ends{a, b};
  for (std::size_t i = 0; i < 2; ++i) {
    const glm::dvec3 along = glm::cross(edge, center - ends[i]);
    for (const double turn : {1.0, -1.0}) {
      const auto normal = tangent_normal(ends[i], along, cast.light, turn);
      if (!normal || glm::dot(*normal, ends[1 - i] - ends[i]) < 0) continue;  // the other tangent
      add(planes, bounding_plane(*normal, cast, m, ends[i]));
    }
  }
  return planes;
}

// ---- both

class Builder {
 public:
  Builder(const LightHull& light, Construction construction) : light_(light), construction_(construction) {}

  /// Returns the wedge of `edge` and the pieces of its splits. Parents are indices in the result.
  [[nodiscard]] std::vector<Wedge> build(const WedgeEdge& edge) const {
    std::vector<Wedge> wedges;
    add_piece(edge, std::nullopt, 0, wedges);
    return wedges;
  }

 private:
  void add_piece(const WedgeEdge& edge, std::optional<std::uint32_t> parent, int splits,
                 std::vector<Wedge>& wedges) const {
    Wedge wedge{edge.a, edge.b, WedgeOutcome::wedge, {}, parent, 0};
    if (edge.a == edge.b) {
      wedge.outcome = WedgeOutcome::empty;
      wedges.push_back(wedge);
      return;
    }
    const EdgeAndLight cast{edge.a, edge.b, light_.corners};
    const std::optional<glm::dvec3> m = separating_direction(cast);
    if (m) wedge.planes = planes_of(cast, *m);
    if (!wedge.planes.empty()) {
      wedge.planes.insert(wedge.planes.end(), edge.crop.begin(), edge.crop.end());
      wedges.push_back(std::move(wedge));
      return;
    }
    // The pieces must equal the edge, to the last bit: their common end must lie on the edge exactly.
    const glm::dvec3 middle = 0.5 * edge.a + 0.5 * edge.b;
    const bool can_split =
        m && splits < kMostSplits && middle != edge.a && middle != edge.b && mesh::collinear(edge.a, middle, edge.b);
    wedge.outcome = can_split ? WedgeOutcome::split : WedgeOutcome::everywhere;
    wedges.push_back(wedge);
    if (!can_split) return;
    const auto self = static_cast<std::uint32_t>(wedges.size() - 1);
    add_piece({edge.a, middle, edge.crop}, self, splits + 1, wedges);
    add_piece({middle, edge.b, edge.crop}, self, splits + 1, wedges);
  }

  [[nodiscard]] std::vector<Plane> planes_of(const EdgeAndLight& cast, const glm::dvec3& m) const {
    return construction_ == Construction::tight ? tight_planes(cast, m) : original_planes(cast, light_.center, m);
  }

  const LightHull& light_;
  Construction construction_;
};

}  // namespace

const char* name_of(WedgeOutcome outcome) {
  switch (outcome) {
    case WedgeOutcome::wedge:
      return "wedge";
    case WedgeOutcome::split:
      return "split";
    case WedgeOutcome::everywhere:
      return "everywhere";
    case WedgeOutcome::empty:
      return "empty";
  }
  return "?";
}

std::vector<Wedge> build_wedges(std::span<const WedgeEdge> edges, const LightHull& light, Construction construction) {
  const Builder builder(light, construction);
  std::vector<std::vector<Wedge>> of_edge(edges.size());
  for_each_index(edges.size(), [&](std::size_t i) { of_edge[i] = builder.build(edges[i]); });
  std::vector<Wedge> wedges;
  for (std::size_t i = 0; i < of_edge.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(wedges.size());
    for (Wedge& wedge : of_edge[i]) {
      if (wedge.parent) *wedge.parent += first;
      wedge.source = static_cast<std::uint32_t>(i);
      wedges.push_back(std::move(wedge));
    }
  }
  return wedges;
}

bool is_inside(const Wedge& wedge, const glm::dvec3& p) {
  return std::ranges::all_of(wedge.planes, [&](const Plane& plane) { return side_of(plane, p) >= 0; });
}

}  // namespace penumbra::volumes
