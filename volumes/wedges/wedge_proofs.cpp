// SPDX-License-Identifier: Apache-2.0
// Proves the invariants of a single wedge with rational arithmetic, independent of the wedge's construction: witnesses
// against planes, a second search for a separating direction (Gilbert 1966), sampled points of the penumbra.

#include "volumes/wedges/wedge_proofs.hpp"

#include "mesh/predicates.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::volumes {
namespace {

/// Random numbers that depend only on the wedge's index (SplitMix64).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u) {}
  std::uint32_t below(std::uint32_t end) {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<std::uint32_t>(((z ^ (z >> 31)) >> 32) % end);
  }
  /// Returns a multiple of 2⁻⁸ in [0, 1], often 0 or 1.
  double share() { return below(3) == 0 ? below(2) : below(257) / 256.0; }

 private:
  std::uint64_t state_;
};

mpq_class dot(const glm::dvec3& n, const std::array<mpq_class, 3>& v) {
  return mpq_class(n.x) * v[0] + mpq_class(n.y) * v[1] + mpq_class(n.z) * v[2];
}

/// Returns n · (x − l).
mpq_class along(const glm::dvec3& n, const glm::dvec3& x, const glm::dvec3& l) {
  const ExactPoint p(x), q(l);
  return dot(n, {p.at[0] - q.at[0], p.at[1] - q.at[1], p.at[2] - q.at[2]});
}

/// Returns (b − a) × (c − a) · (q − a).
mpq_class volume(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& q) {
  const ExactPoint a(triangle[0]), b(triangle[1]), c(triangle[2]), p(q);
  std::array<mpq_class, 3> u, v, w;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = b.at[k] - a.at[k];
    v[k] = c.at[k] - a.at[k];
    w[k] = p.at[k] - a.at[k];
  }
  return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2];
}

/// Returns from + share (to − from).
ExactPoint between(const ExactPoint& from, const ExactPoint& to, double share) {
  std::array<mpq_class, 3> at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = from.at[k] + mpq_class(share) * (to.at[k] - from.at[k]);
  return ExactPoint(std::move(at));
}

double distance_beyond(const Plane& plane, const ExactPoint& p) {
  return -height_of(plane, p).get_d() / glm::length(plane.normal());
}

/// Returns a point of the penumbra, x + t (x − l), that is outside the half-space, if an end x or a ray x − l proves
/// that there is one. Of the points tried, it is the one farthest outside.
std::optional<ExactPoint> witness_against(const Plane& plane, const EdgeAndLight& cast) {
  std::optional<ExactPoint> farthest;
  double distance = 0;
  for (const glm::dvec3& x : {cast.a, cast.b}) {
    for (const glm::dvec3& l : cast.light) {
      const ExactPoint end(x), corner(l);
      const mpq_class above = height_of(plane, end), rise = above - height_of(plane, corner);
      if (sgn(above) >= 0 && sgn(rise) >= 0) continue;
      mpq_class t = 1;  // if the height falls along the ray, t must be large enough to end below the plane; if the
                        // height rises, small enough not to end above
      if (sgn(above) >= 0) t = 1 - above / rise;
      if (sgn(above) < 0 && sgn(rise) > 0) t = -above / (2 * rise);
      std::array<mpq_class, 3> at;
      for (std::size_t k = 0; k < 3; ++k) at[k] = end.at[k] + t * (end.at[k] - corner.at[k]);
      ExactPoint point(std::move(at));
      if (farthest && distance_beyond(plane, point) <= distance) continue;
      distance = distance_beyond(plane, point);
      farthest = std::move(point);
    }
  }
  return farthest;
}

/// Returns a direction that has a positive product with every x − l. It is found by iterating to the point of their
/// hull nearest to zero (Gilbert 1966), independently of separating_direction.
std::optional<glm::dvec3> other_separating_direction(const EdgeAndLight& cast) {
  std::vector<glm::dvec3> directions;
  for (const glm::dvec3& l : cast.light) directions.insert(directions.end(), {cast.a - l, cast.b - l});
  glm::dvec3 at = directions.front();
  for (int step = 0; step < 1000; ++step) {
    const glm::dvec3 lowest = *std::ranges::min_element(directions, {}, [&](const auto& w) { return glm::dot(at, w); });
    if (glm::dot(at, lowest) > 0) break;
    const glm::dvec3 d = lowest - at;
    at += std::clamp(-glm::dot(at, d) / glm::dot(d, d), 0.0, 1.0) * d;
  }
  const bool separates = std::ranges::all_of(
      cast.light, [&](const glm::dvec3& l) { return sign_along(at, cast.a, l) > 0 && sign_along(at, cast.b, l) > 0; });
  return separates ? std::optional(at) : std::nullopt;
}

bool holds(const Box& box, const glm::dvec3& p) {
  return glm::all(glm::lessThanEqual(box.lower, p)) && glm::all(glm::lessThanEqual(p, box.upper));
}

}  // namespace

struct WedgeProofs::Job {
  std::uint32_t number;
  const Wedge& wedge;
  EdgeAndLight cast;
  std::span<const Plane> crops;
  ValidationReport& report;

  void checked(Invariant invariant) { ++report.checks[static_cast<std::size_t>(invariant)]; }
  void fail(Invariant invariant, std::optional<std::uint32_t> plane, const glm::dvec3& point, double distance,
            std::string what) {
    report.violations.push_back({invariant, number, plane, point, distance, std::move(what)});
  }
};

void WedgeProofs::check(std::uint32_t number, ValidationReport& report) const {
  const Wedge& wedge = input_.wedges[number];
  const bool known = wedge.source < input_.casting.wedges.size();  // if false, `cover` has reported the wedge
  const std::span<const Plane> crops =
      known ? std::span<const Plane>(input_.casting.wedges[wedge.source].crop) : std::span<const Plane>();
  Job job{number, wedge, {wedge.a, wedge.b, input_.light.corners}, crops, report};
  check_outcome(job);
  if (wedge.outcome != WedgeOutcome::wedge) return;
  const std::size_t before = report.violations.size();
  check_numbers(job);
  if (report.violations.size() != before) return;  // nothing more can be checked about such planes
  check_planes(job);
  check_points(job);
  check_polyhedron(job);
}

void WedgeProofs::check_outcome(Job& job) const {
  const Wedge& wedge = job.wedge;
  job.checked(Invariant::outcome);
  if ((wedge.outcome == WedgeOutcome::wedge) == wedge.planes.empty()) {
    job.fail(Invariant::outcome, {}, wedge.a, 0,
             fmt::format("{} with {} planes", name_of(wedge.outcome), wedge.planes.size()));
  }
  if (wedge.outcome == WedgeOutcome::empty && wedge.a != wedge.b) {
    job.fail(Invariant::outcome, {}, wedge.a, glm::length(wedge.b - wedge.a),
             "the outcome is `empty`, though the edge has a length");
  }
  if (wedge.outcome == WedgeOutcome::everywhere && input_.tight && other_separating_direction(job.cast)) {
    job.fail(Invariant::outcome, {}, wedge.a, 0,
             "the outcome is `everywhere`, though a plane separates the edge from the light");
  }
}

void WedgeProofs::check_numbers(Job& job) const {
  for (std::uint32_t i = 0; i < job.wedge.planes.size(); ++i) {
    const Plane& plane = job.wedge.planes[i];
    job.checked(Invariant::numbers);
    const bool finite =
        std::isfinite(plane.a) && std::isfinite(plane.b) && std::isfinite(plane.c) && std::isfinite(plane.d);
    if (!finite || plane.normal() == glm::dvec3(0)) {
      job.fail(Invariant::numbers, i, job.wedge.a, 0, finite ? "a normal of zero" : "not finite");
    }
  }
}

void WedgeProofs::check_planes(Job& job) const {
  for (std::uint32_t i = 0; i < job.wedge.planes.size(); ++i) {
    const Plane& plane = job.wedge.planes[i];
    job.checked(Invariant::conservative);
    if (bounds_penumbra(plane, job.cast)) continue;
    if (is_proved_crop(job, plane)) {
      ++job.report.cropped_planes;
      continue;
    }
    const std::optional<ExactPoint> p = witness_against(plane, job.cast);
    job.fail(Invariant::conservative, i, p ? p->near : job.wedge.a, p ? distance_beyond(plane, *p) : 0,
             "a point of the penumbra lies outside");
  }
}

/// Returns whether n · (x − l) ≥ 0 on the part of the light where s h_T(l) ≥ 0. It tests the light's corners in this
/// part, and the points where a segment between two corners leaves the part: all segments, since stored corners need
/// not be on one plane.
bool WedgeProofs::is_proved_crop(const Job& job, const Plane& plane) const {
  const auto same = [&](const Plane& crop) { return crop.normal() == plane.normal() && crop.d == plane.d; };
  if (std::ranges::none_of(job.crops, same)) return false;
  const auto crop = crop_of(input_.casters, input_.casting.edges[job.wedge.source], input_.light);
  if (!crop || side_of(plane, job.cast.a) < 0 || side_of(plane, job.cast.b) < 0) return false;
  std::vector<mpq_class> heights;
  for (const glm::dvec3& l : job.cast.light) heights.emplace_back(crop->others * volume(crop->triangle, l));
  for (const glm::dvec3& x : {job.cast.a, job.cast.b}) {
    std::vector<mpq_class> directions;
    for (const glm::dvec3& l : job.cast.light) directions.push_back(along(plane.normal(), x, l));
    for (std::size_t i = 0; i < directions.size(); ++i) {
      if (sgn(heights[i]) < 0) continue;
      if (sgn(directions[i]) < 0) return false;
      for (std::size_t j = 0; j < directions.size(); ++j) {
        if (sgn(heights[j]) >= 0 || sgn(directions[j]) >= 0) continue;
        if (directions[j] * heights[i] < directions[i] * heights[j]) return false;
      }
    }
  }
  return true;
}

bool WedgeProofs::is_silhouette_from(const Job& job, const ExactPoint& p) const {
  const mesh::EdgeGraph& graph = input_.casters.graph;
  const std::uint32_t edge = input_.casting.edges[job.wedge.source];
  const ExactPoint a(input_.casters.positions[graph.edges[edge].a]), b(input_.casters.positions[graph.edges[edge].b]);
  int sum = 0;
  for (const mesh::Incidence& around : graph.around(edge)) {
    sum += orientation(a, b, ExactPoint(input_.casters.positions[around.apex]), p);
  }
  return sum != 0;
}

void WedgeProofs::check_points(Job& job) const {
  Draw draw(job.number);
  const ExactPoint a(job.wedge.a), b(job.wedge.b);
  const auto corner = [&] {
    return ExactPoint(job.cast.light[draw.below(static_cast<std::uint32_t>(job.cast.light.size()))]);
  };
  for (std::uint32_t i = 0; i < input_.points_per_wedge; ++i) {
    const ExactPoint x = between(a, b, draw.share());
    const ExactPoint l = between(between(corner(), corner(), draw.share()), corner(), draw.share());
    const ExactPoint p = between(l, x, 1 + std::ldexp(1 + draw.share(), static_cast<int>(draw.below(16)) - 8));
    job.checked(Invariant::sampled);
    for (std::uint32_t k = 0; k < job.wedge.planes.size(); ++k) {
      if (side_of(job.wedge.planes[k], p) >= 0 || (!job.crops.empty() && !is_silhouette_from(job, p))) continue;
      job.fail(Invariant::sampled, k, p.near, distance_beyond(job.wedge.planes[k], p),
               "a sampled point of the penumbra lies outside");
      return;
    }
  }
}

void WedgeProofs::check_polyhedron(Job& job) const {
  const Polyhedron polyhedron = cut_box(box_, job.wedge.planes);
  job.checked(Invariant::polyhedron);
  if (polyhedron.extent == Extent::empty) {
    // A wedge contains its edge, and the box contains the edge.
    job.fail(Invariant::polyhedron, {}, job.wedge.a, 0, "nothing of the wedge is in the scene's box");
  } else if (polyhedron.extent == Extent::flat) {
    ++job.report.flat;
  } else if (const auto flaw = flaw_of(polyhedron)) {
    job.fail(Invariant::polyhedron, {}, job.wedge.a, 0, *flaw);
  } else {
    check_half_spaces(job, polyhedron);
  }
}

void WedgeProofs::check_half_spaces(Job& job, const Polyhedron& polyhedron) const {
  Draw draw(job.number);
  const auto corner = [&] {
    return polyhedron.corners[draw.below(static_cast<std::uint32_t>(polyhedron.corners.size()))].near;
  };
  for (std::uint32_t i = 0; i < input_.points_per_wedge; ++i) {
    glm::dvec3 p;
    if (i % 2 == 0) {  // in or near the polyhedron: between its corners, or slightly beyond
      p = glm::mix(glm::mix(corner(), corner(), draw.share()), corner(), 1.25 * draw.share());
    } else {
      p = glm::mix(box_.lower, box_.upper, glm::dvec3(draw.share(), draw.share(), draw.share()));
    }
    job.checked(Invariant::half_spaces);
    const bool inside = holds(box_, p) && is_inside(job.wedge, p);
    if (inside == mesh_holds(polyhedron, p)) continue;
    job.fail(Invariant::half_spaces, {}, p, 0,
             inside ? "a point is inside all half-spaces, but outside the mesh" : "inside the mesh only");
  }
}

}  // namespace penumbra::volumes
