// SPDX-License-Identifier: Apache-2.0
// Computes the coverage integral of soft shadow volumes: U. Assarsson, T. Akenine-Möller, "A geometry-based soft shadow
// volume algorithm using graphics hardware", 2003. Departs from the paper: instead of a table of arc tangents for
// sectors, a sector of a polygon is a linear function along each side of the polygon; C need not be the light's centre.

#include "volumes/wedges/radial_coverage.hpp"

#include "base/assert.hpp"
#include "mesh/predicates.hpp"
#include "visibility/pair_truth.hpp"
#include "volumes/wedges/planar.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace penumbra::volumes {
namespace {

constexpr std::array kSquare = {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)};

/// Returns the sizes of the terms of a × b, before cancellation.
glm::dvec3 cross_size(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 x = glm::abs(a), y = glm::abs(b);
  return {x.y * y.z + x.z * y.y, x.z * y.x + x.x * y.z, x.x * y.y + x.y * y.x};
}

/// A part [from, to] of an edge's parameter.
struct Range {
  double from = 0, to = 1;

  /// Keeps the part of the range where a height that is `a` at 0 and `b` at 1 is positive. Returns false if nothing is
  /// left.
  bool cut(double a, double b) {
    if (a <= 0 && b <= 0) return false;
    if (a < 0) from = std::max(from, a / (a - b));
    if (b < 0) to = std::min(to, a / (a - b));
    return from < to;
  }
};

/// Returns the part within the disk of an edge already clipped to the square around the disk. It is computed on the
/// light's plane, not before projection: for an edge that passes close to p, X² + Y² ≤ W² would be decided by the
/// squares of small differences.
std::optional<ClippedEdge> cut_by_disk(const ClippedEdge& edge) {
  const glm::dvec2 toward = edge.to - edge.from;
  const double size = glm::dot(toward, toward), half = glm::dot(edge.from, toward),
               rest = glm::dot(edge.from, edge.from) - 1;
  const bool from_inside = rest <= 0, to_inside = glm::dot(edge.to, edge.to) <= 1;
  if (from_inside && to_inside) return edge;
  const double discriminant = half * half - size * rest;
  if (!(discriminant > 0)) return std::nullopt;
  const double q = -(half + std::copysign(std::sqrt(discriminant), half));
  const double low = std::min(q / size, rest / q), high = std::max(q / size, rest / q);
  Range range;
  if (!from_inside) range.from = std::max(0.0, low);
  if (!to_inside) range.to = std::min(1.0, high);
  if (!(range.from < range.to)) return std::nullopt;
  ClippedEdge inside = edge;
  if (!from_inside) inside.from = edge.from + range.from * toward;
  if (!to_inside) inside.to = edge.from + range.to * toward;
  inside.from_error = inside.to_error = std::max(edge.from_error, edge.to_error);
  return inside;
}

Projected mix(const Projected& a, const Projected& b, double t) {
  const double s = 1 - t;
  return {s * a.x + t * b.x,
          s * a.y + t * b.y,
          s * a.w + t * b.w,
          s * a.error_x + t * b.error_x,
          s * a.error_y + t * b.error_y,
          s * a.error_w + t * b.error_w};
}

}  // namespace

LightOutline light_outline(const visibility::Light& light) {
  if (is_round(light.kind)) return {{}, std::numbers::pi};
  if (is_parallelogram(light.kind)) return {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 4};
  const auto [center, u, v] = visibility::light_frame(light);
  const glm::dvec3 n = glm::cross(u, v);
  LightOutline outline;
  for (const glm::vec3& corner : light.outline) {
    const glm::dvec3 d = glm::dvec3(corner) - center;
    outline.corners.push_back(glm::dvec2(glm::dot(glm::cross(d, v), n), glm::dot(glm::cross(u, d), n)) /
                              glm::dot(n, n));
  }
  outline.area = area_of(outline.corners);
  if (outline.area < 0) {
    std::ranges::reverse(outline.corners);
    outline.area = -outline.area;
  }
  return outline;
}

double share_above(const LightOutline& outline, double at, const glm::dvec2& along) {
  if (outline.corners.empty()) {
    const double size = glm::length(along);
    if (!(size > std::abs(at))) return at > 0 ? 1 : 0;
    const double d = at / size;
    return (std::acos(-d) + d * std::sqrt((1 - d) * (1 + d))) / std::numbers::pi;
  }
  std::vector<glm::dvec2> left;
  bool whole = true;
  for (std::size_t i = 0; i < outline.corners.size(); ++i) {
    const glm::dvec2 &a = outline.corners[i], &b = outline.corners[(i + 1) % outline.corners.size()];
    const double at_a = at + glm::dot(along, a), at_b = at + glm::dot(along, b);
    whole = whole && at_a >= 0;
    if (at_a >= 0) left.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) left.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  if (whole) return 1;
  return left.empty() ? 0 : std::clamp(area_of(left) / outline.area, 0.0, 1.0);
}

double Projected::error() const {
  const glm::dvec2 at = glm::abs(point());
  return (error_x + error_y + (at.x + at.y) * error_w) / w;
}

// With r = p − o, d = x − p: S = −det(r, v, d), T = −det(u, r, d), W = −det(u, v, d), over K = det(u, v, r), as in
// areas/back_projection.hpp. d is computed first: an edge that nearly touches p is as precise as any other.
LightProjection::LightProjection(const visibility::Light& light, const glm::vec3& p) : p_(p) {
  if (is_body(light.kind)) {
    turn_ = in_front_of_light(light, p) ? 1 : 0;
  } else {
    turn_ = static_cast<int>(mesh::side_of_plane(light.center, light.center_u, light.center_v, p));
  }
  PENUMBRA_ASSERT(turn_ != 0, "({}, {}, {}) is on the plane of light {}", p.x, p.y, p.z, light.name);
  const auto [center, u, v] = visibility::light_frame_from(light, p);
  const glm::dvec3 r = p_ - center, n = glm::cross(u, v);
  double k = glm::dot(n, r);
  // p is so near the plane that double precision cannot resolve K
  if (k * turn_ <= 0) k = turn_ * std::numeric_limits<double>::min();
  row_x_ = glm::cross(v, r) / k;
  row_y_ = glm::cross(r, u) / k;
  row_w_ = -n / k;
  // 16 · 2⁻⁵³ = 2⁻⁴⁹ covers a difference, another, a product, a difference, a quotient; a difference, a product, two
  // sums.
  const double rounding = 0x1p-49 / std::abs(k);
  size_x_ = rounding * cross_size(v, r);
  size_y_ = rounding * cross_size(r, u);
  size_w_ = rounding * cross_size(u, v);
}

Projected LightProjection::operator()(const glm::dvec3& x) const {
  const glm::dvec3 d = x - p_, size = glm::abs(d);
  return {glm::dot(row_x_, d),     glm::dot(row_y_, d),     glm::dot(row_w_, d),
          glm::dot(size_x_, size), glm::dot(size_y_, size), glm::dot(size_w_, size)};
}

bool LightProjection::misses(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec2& lower,
                             const glm::dvec2& upper) const {
  const glm::dvec3 to_a = a - p_, to_b = b - p_;
  const double w_a = glm::dot(row_w_, to_a), w_b = glm::dot(row_w_, to_b);
  if ((w_a <= 0 && w_b <= 0) || (w_a >= 1 && w_b >= 1)) return true;
  const double x_a = glm::dot(row_x_, to_a), x_b = glm::dot(row_x_, to_b);
  if ((x_a < lower.x * w_a && x_b < lower.x * w_b) || (x_a > upper.x * w_a && x_b > upper.x * w_b)) return true;
  const double y_a = glm::dot(row_y_, to_a), y_b = glm::dot(row_y_, to_b);
  return (y_a < lower.y * w_a && y_b < lower.y * w_b) || (y_a > upper.y * w_a && y_b > upper.y * w_b);
}

std::optional<ClippedEdge> clip_to_light(const LightOutline& outline, const Projected& a, const Projected& b) {
  const bool is_disk = outline.corners.empty();
  const std::span<const glm::dvec2> corners = is_disk ? std::span<const glm::dvec2>(kSquare) : outline.corners;
  Range range;
  if (!range.cut(a.w, b.w) || !range.cut(1 - a.w, 1 - b.w)) return std::nullopt;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 &corner = corners[i], side = corners[(i + 1) % corners.size()] - corner;
    const auto height = [&](const Projected& q) {
      return cross2(side, glm::dvec2(q.x - q.w * corner.x, q.y - q.w * corner.y));
    };
    if (!range.cut(height(a), height(b))) return std::nullopt;
  }
  const Projected from = range.from == 0 ? a : mix(a, b, range.from), to = range.to == 1 ? b : mix(a, b, range.to);
  if (!(from.w > 0) || !(to.w > 0)) return std::nullopt;  // p is on the edge: the edge has no extent
  const ClippedEdge edge{from.point(), to.point(), from.error(), to.error()};
  return is_disk ? cut_by_disk(edge) : edge;
}

RadialCoverage::RadialCoverage(const LightOutline& outline, const glm::dvec2& reference, Arc arc)
    : outline_(&outline),
      reference_(reference),
      by_cosine_(arc == Arc::cosine && outline.corners.empty() && reference == glm::dvec2(0)) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.corners.size(); ++i) {
    up_to_.push_back(sum);
    sum += cross2(outline.corners[i] - reference, outline.corners[(i + 1) % outline.corners.size()] - reference) / 2;
  }
}

/// Returns the area swept, up to multiples of |L|, when a ray from C has turned to `direction`.
double RadialCoverage::fan_area(const glm::dvec2& direction) const {
  if (outline_->corners.empty()) {
    // h: point where the ray leaves the disk. Green's theorem along the arc: ½ ∮ (q − C) × dq = ½ φ − ½ C × h, up to a
    // constant.
    const glm::dvec2 d = direction / glm::length(direction);
    const double along = glm::dot(reference_, d), across = cross2(reference_, d);
    const glm::dvec2 h = reference_ + (std::sqrt(std::max(0.0, 1 - across * across)) - along) * d;
    return (std::atan2(h.y, h.x) - cross2(reference_, h)) / 2;
  }
  const std::vector<glm::dvec2>& corners = outline_->corners;
  std::size_t side = 0;
  double best = -std::numeric_limits<double>::infinity(), before = 0, after = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double to_i = cross2(corners[i] - reference_, direction),
                 to_next = cross2(direction, corners[(i + 1) % corners.size()] - reference_);
    if (std::min(to_i, to_next) <= best) continue;
    best = std::min(to_i, to_next);
    side = i;
    before = to_i;
    after = to_next;
  }
  const double share = std::clamp(before / (before + after), 0.0, 1.0);
  const double whole = cross2(corners[side] - reference_, corners[(side + 1) % corners.size()] - reference_) / 2;
  return up_to_[side] + share * whole;
}

double RadialCoverage::beyond(const ClippedEdge& edge, int side) const {
  const glm::dvec2 from = edge.from - reference_, to = edge.to - reference_;
  const double turned = cross2(from, to), area = outline_->area;
  if (by_cosine_) {
    const double cosine = glm::dot(from, to) / (glm::length(from) * glm::length(to));
    return (side * std::acos(std::clamp(cosine, -1.0, 1.0)) - turned) / 2;
  }
  double sector = fan_area(to) - fan_area(from);
  if (glm::dot(from, to) > 0) {
    // Less than a quarter turn: rounding may have reversed the sector's sign, but its magnitude is right. A quarter
    // turn around a point well inside never contains 15/16 of a convex region, and no rounding reaches 1/16.
    if (sector < (turned > 0 ? -area / 16 : -area * 15 / 16)) sector += area;
    if (sector > (turned < 0 ? area / 16 : area * 15 / 16)) sector -= area;
  } else {
    if (side > 0 && sector < 0) sector += area;
    if (side < 0 && sector > 0) sector -= area;
  }
  return sector - turned / 2;
}

bool RadialCoverage::is_clear_of(const glm::dvec2& end, double error) const {
  return glm::length(end - reference_) > 4 * error;
}

}  // namespace penumbra::volumes
