// A wedge is cut by the receivers' box and by a plane in front of the nearest receiver, so no corner is behind the eye,
// and nothing is special about an eye within. The convex hull of what is left, projected, is the footprint.

#include "volumes/wedge_footprint.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::volumes {
namespace {

/// An eighth of a pixel is what callers may rely on; the rest is for the rasteriser, as in screen_box.cpp.
constexpr double kPad = 0.25;

double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

double cross(const glm::dvec2& u, const glm::dvec2& v) {
  return u.x * v.y - u.y * v.x;
}

/// A convex polyhedron by its faces; each has its own copies of the corners. Half-spaces are moved outward by 2⁻⁴⁰ of
/// the terms that their heights are made of, more than rounding takes here.
using Loop = std::vector<glm::dvec3>;

/// The corners on a plane of this normal, in order around their middle.
Loop cap_of(Loop corners, const glm::dvec3& normal) {
  glm::dvec3 middle(0);
  for (const glm::dvec3& x : corners) middle += x / static_cast<double>(corners.size());
  const glm::dvec3 size = glm::abs(normal);
  const glm::dvec3 axis = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                          : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                               : glm::dvec3(0, 0, 1);
  const glm::dvec3 u = glm::normalize(glm::cross(normal, axis)), v = glm::cross(glm::normalize(normal), u);
  const auto angle = [&](const glm::dvec3& x) { return std::atan2(glm::dot(v, x - middle), glm::dot(u, x - middle)); };
  std::ranges::sort(corners, {}, angle);
  return corners;
}

void clip(std::vector<Loop>& faces, const Plane& plane, double reach) {
  const glm::dvec3 normal = plane.normal();
  const double margin = 0x1p-40 * (3 * largest(normal) * reach + std::abs(plane.d));
  const auto height = [&](const glm::dvec3& x) { return glm::dot(normal, x) + plane.d + margin; };
  Loop cut;
  for (Loop& face : faces) {
    Loop kept;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const glm::dvec3 &from = face[i], &to = face[(i + 1) % face.size()];
      const double d = height(from), e = height(to);
      if (d >= 0) kept.push_back(from);
      if ((d < 0 && e > 0) || (d > 0 && e < 0)) {
        kept.push_back(from + (to - from) * (d / (d - e)));
        cut.push_back(kept.back());
      }
    }
    face = std::move(kept);
  }
  std::erase_if(faces, [](const Loop& face) { return face.empty(); });
  if (cut.size() > 2) faces.push_back(cap_of(std::move(cut), normal));
}

using Points = std::vector<glm::dvec2>;

/// Counter-clockwise where y goes up (A. M. Andrew 1979).
Points hull_of(Points points) {
  std::ranges::sort(points, [](const auto& p, const auto& q) { return p.x != q.x ? p.x < q.x : p.y < q.y; });
  Points hull;
  for (const int way : {1, -1}) {
    const std::size_t floor = hull.size() + 1;
    for (const glm::dvec2& p : points) {
      while (hull.size() > floor && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    if (way == 1) std::ranges::reverse(points);
  }
  return hull;
}

/// The part where sign · p[axis] ≤ limit.
Points clip(const Points& polygon, int axis, double sign, double limit) {
  Points kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double d = limit - sign * from[axis], e = limit - sign * to[axis];
    if (d >= 0) kept.push_back(from);
    if ((d < 0 && e > 0) || (d > 0 && e < 0)) kept.push_back(from + (to - from) * (d / (d - e)));
  }
  return kept;
}

/// Takes away the edge that adds least when its neighbours are extended until they meet. False: none do.
bool drop_edge(Points& polygon) {
  const std::size_t n = polygon.size();
  double least = std::numeric_limits<double>::infinity();
  std::size_t which = n;
  glm::dvec2 corner(0);
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % n];
    const glm::dvec2 before = a - polygon[(i + n - 1) % n], after = polygon[(i + 2) % n] - b;
    const double turn = cross(before, after);
    if (!(turn > 0)) continue;
    const glm::dvec2 meet = a + before * (cross(b - a, after) / turn);
    const double area = std::abs(cross(b - a, meet - b)) / 2;
    if (area < least) {
      least = area;
      which = i;
      corner = meet;
    }
  }
  if (which == n) return false;
  polygon[which] = corner;
  polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>((which + 1) % n));
  return true;
}

}  // namespace

std::optional<Receivers> receivers_of(const visibility::ViewSamples& samples) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Receivers receivers{{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)}, kInfinity};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.triangle[i] == visibility::ViewSamples::kBackground) continue;
    const glm::dvec3 p(samples.p[i]);
    receivers.bounds = {glm::min(receivers.bounds.lower, p), glm::max(receivers.bounds.upper, p)};
    receivers.nearest = std::min(receivers.nearest, glm::dot(samples.camera.forward, p - samples.camera.eye));
  }
  if (!(receivers.nearest < kInfinity)) return std::nullopt;
  // Half: nothing that is seen is cut off, and nothing projects to infinity.
  receivers.nearest = std::max(receivers.nearest / 2, std::numeric_limits<double>::min());
  return receivers;
}

FootprintFinder::FootprintFinder(const visibility::PinholeCamera& camera, const Receivers& receivers)
    : camera_(camera),
      receivers_(receivers),
      reach_(std::max(largest(receivers.bounds.lower), largest(receivers.bounds.upper))) {}

std::vector<Loop> FootprintFinder::box() const {
  const auto corner = [&](unsigned i) {
    const Box& b = receivers_.bounds;
    return glm::dvec3((i & 1) != 0 ? b.upper.x : b.lower.x, (i & 2) != 0 ? b.upper.y : b.lower.y,
                      (i & 4) != 0 ? b.upper.z : b.lower.z);
  };
  std::vector<Loop> faces;
  for (const auto& [a, b, c, d] : {std::array{0u, 4u, 6u, 2u},
                                   {1u, 3u, 7u, 5u},
                                   {0u, 1u, 5u, 4u},
                                   {2u, 6u, 7u, 3u},
                                   {0u, 2u, 3u, 1u},
                                   {4u, 5u, 7u, 6u}}) {
    faces.push_back({corner(a), corner(b), corner(c), corner(d)});
  }
  return faces;
}

std::optional<Footprint> FootprintFinder::around(std::span<const Wedge> pieces) const {
  const glm::dvec2 half(0.5 * camera_.width, 0.5 * camera_.height);
  const glm::dvec3 across = camera_.right / (camera_.tan_half_fov * camera_.width / camera_.height);
  const glm::dvec3 upward = camera_.up / camera_.tan_half_fov, &forward = camera_.forward;
  const Plane in_front{forward.x, forward.y, forward.z, -glm::dot(forward, camera_.eye) - receivers_.nearest};
  Points points;
  for (const Wedge& wedge : pieces) {
    if (wedge.outcome == WedgeOutcome::empty || wedge.outcome == WedgeOutcome::split) continue;
    std::vector<Loop> faces = box();
    clip(faces, in_front, reach_);
    for (const Plane& plane : wedge.planes) clip(faces, plane, reach_);
    for (const Loop& face : faces) {
      for (const glm::dvec3& x : face) {
        const glm::dvec3 d = x - camera_.eye;
        const double w = glm::dot(forward, d);
        const glm::dvec2 at = half + glm::dvec2(glm::dot(across, d), -glm::dot(upward, d)) / w * half;
        for (const glm::dvec2& pad : {glm::dvec2(kPad, kPad), {-kPad, kPad}, {kPad, -kPad}, {-kPad, -kPad}}) {
          points.push_back(at + pad);
        }
      }
    }
  }
  if (points.empty()) return std::nullopt;
  Points polygon = hull_of(std::move(points));
  for (int axis = 0; axis < 2; ++axis) {
    polygon = clip(clip(polygon, axis, 1, 2 * half[axis] + 1), axis, -1, 1);
  }
  if (polygon.size() < 3) return std::nullopt;
  while (polygon.size() > Footprint::kMost) {
    if (!drop_edge(polygon)) {
      polygon = {{-1, -1}, {2 * half.x + 1, -1}, 2.0 * half + 1.0, {-1, 2 * half.y + 1}};
    }
  }
  Footprint footprint;
  footprint.size = polygon.size();
  std::ranges::copy(polygon, footprint.corners.begin());
  return footprint;
}

}  // namespace penumbra::volumes
