// SPDX-License-Identifier: Apache-2.0
// Screen footprints of penumbra wedges. A wedge is cut by the receivers' box and by a plane in front of the nearest
// receiver, so no corner is behind the eye, and an eye inside the wedge is no special case. The footprint is the convex
// hull of the projected remainder.

#include "volumes/raster/wedge_footprint.hpp"

#include "volumes/wedges/planar.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::volumes {
namespace {

/// Callers may rely on an eighth of a pixel; the rest is for the rasteriser, as in screen_box.cpp.
constexpr double kPad = 0.25;

double cross(const glm::dvec2& u, const glm::dvec2& v) {
  return u.x * v.y - u.y * v.x;
}

/// A face of a convex polyhedron; each face has its own copies of the corners. Half-spaces are moved outward by 2⁻⁴⁰ of
/// the terms of their heights, which is more than the rounding here.
using Loop = std::vector<glm::dvec3>;

/// Returns the corners on a plane with this normal, in order around their middle.
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

double margin_of(const Plane& plane, double reach) {
  return 0x1p-40 * (3 * largest(plane.normal()) * reach + std::abs(plane.d));
}

/// Returns whether no point of the box is in the half-space.
bool is_beyond(const Box& box, const Plane& plane) {
  const double reach = std::max(largest(box.lower), largest(box.upper));
  double highest = plane.d + margin_of(plane, reach);
  const glm::dvec3 normal = plane.normal();
  for (int i = 0; i < 3; ++i) highest += std::max(normal[i] * box.lower[i], normal[i] * box.upper[i]);
  return highest < 0;
}

void clip(std::vector<Loop>& faces, const Plane& plane, double reach) {
  const glm::dvec3 normal = plane.normal();
  const double margin = margin_of(plane, reach);
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

std::vector<Loop> faces_of(const Box& box) {
  const auto corner = [&](unsigned i) {
    return glm::dvec3((i & 1) != 0 ? box.upper.x : box.lower.x, (i & 2) != 0 ? box.upper.y : box.lower.y,
                      (i & 4) != 0 ? box.upper.z : box.lower.z);
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

using Points = std::vector<glm::dvec2>;

/// Returns the intersection of two convex polygons.
Points clip(Points polygon, const Points& by) {
  for (std::size_t side = 0; side < by.size(); ++side) {
    const glm::dvec2 &start = by[side], direction = by[(side + 1) % by.size()] - start;
    Points kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec2 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
      const double d = cross(direction, from - start), e = cross(direction, to - start);
      if (d >= 0) kept.push_back(from);
      if ((d < 0 && e > 0) || (d > 0 && e < 0)) kept.push_back(from + (to - from) * (d / (d - e)));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

/// Removes the edge that adds the least area when its neighbours are extended until they meet. Returns false if no
/// neighbours meet.
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

Receivers::Receivers(const visibility::ViewSamples& samples, const std::optional<glm::dvec3>& center)
    : columns_((samples.width + kBlock - 1) / kBlock), rows_((samples.height + kBlock - 1) / kBlock) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  blocks_.assign(std::size_t{columns_} * rows_, {glm::dvec3(kEndless), glm::dvec3(-kEndless)});
  double nearest = kEndless;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.triangle[i] == visibility::ViewSamples::kBackground) continue;
    const glm::dvec3 p(samples.p[i]);
    if (center) {
      // n is a unit vector in float32, off by about 2⁻²²; p is off its plane by an ulp of its coordinates.
      const glm::dvec3 direction = *center - p;
      const double size = largest(direction) + largest(p) + largest(*center);
      if (glm::dot(glm::dvec3(samples.n[i]), direction) < -0x1p-18 * size) continue;
    }
    const std::size_t x = i % samples.width / kBlock, y = i / samples.width / kBlock;
    Box& block = blocks_[y * columns_ + x];
    block = {glm::min(block.lower, p), glm::max(block.upper, p)};
    nearest = std::min(nearest, glm::dot(samples.camera.forward, p - samples.camera.eye));
    reach_ = std::max(reach_, largest(p));
  }
  bounds_ = blocks_.empty() ? Box{} : blocks_.front();
  for (const Box& block : blocks_) {
    bounds_ = {glm::min(bounds_.lower, block.lower), glm::max(bounds_.upper, block.upper)};
  }
  if (nearest < kEndless) nearest_ = std::max(nearest / 2, std::numeric_limits<double>::min());
}

FootprintFinder::FootprintFinder(const visibility::PinholeCamera& camera, const Receivers& receivers, WedgeTests tests)
    : camera_(camera), receivers_(&receivers), tests_(tests) {}

void FootprintFinder::add_projection(const Wedge& wedge, Points& points) const {
  const glm::dvec2 half(0.5 * camera_.width, 0.5 * camera_.height);
  const glm::dvec3 across = camera_.screen_across(), upward = camera_.screen_upward(), &forward = camera_.forward;
  std::vector<Loop> faces = faces_of(receivers_->bounds());
  clip(faces, {forward.x, forward.y, forward.z, -glm::dot(forward, camera_.eye) - receivers_->nearest()},
       receivers_->reach());
  for (const Plane& plane : wedge.planes) clip(faces, plane, receivers_->reach());
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

/// Returns the corners of those blocks in the polygon that may have a receiver in one of the wedges.
Points FootprintFinder::blocks_in(std::span<const Wedge> pieces, const Points& polygon) const {
  glm::dvec2 lower = polygon.front(), upper = lower;
  for (const glm::dvec2& p : polygon) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  Points points;
  receivers_->for_each_block(lower, upper, [&](const glm::dvec2& low, const glm::dvec2& high, const Box& box) {
    const bool reached = std::ranges::any_of(pieces, [&](const Wedge& wedge) {
      if (wedge.outcome == WedgeOutcome::empty || wedge.outcome == WedgeOutcome::split) return false;
      return std::ranges::none_of(wedge.planes, [&](const Plane& plane) { return is_beyond(box, plane); });
    });
    if (reached)
      points.insert(points.end(),
                    {low - kPad, high + kPad, {low.x - kPad, high.y + kPad}, {high.x + kPad, low.y - kPad}});
  });
  return points;
}

std::optional<Footprint> FootprintFinder::around(std::span<const Wedge> pieces) const {
  Points points;
  for (const Wedge& wedge : pieces) {
    if (wedge.outcome != WedgeOutcome::empty && wedge.outcome != WedgeOutcome::split) add_projection(wedge, points);
  }
  if (points.empty()) return std::nullopt;
  const glm::dvec2 size(camera_.width, camera_.height);
  const Points screen{{-1, -1}, {size.x + 1, -1}, size + 1.0, {-1, size.y + 1}};
  Points polygon = clip(hull_of(std::move(points)), screen);
  if (tests_ != WedgeTests::none && polygon.size() >= 3) {
    Points blocks = blocks_in(pieces, polygon);
    polygon = blocks.empty() ? Points{} : clip(polygon, hull_of(std::move(blocks)));
  }
  if (polygon.size() < 3) return std::nullopt;
  while (polygon.size() > Footprint::kMost) {
    if (!drop_edge(polygon)) polygon = screen;
  }
  Footprint footprint;
  footprint.size = polygon.size();
  std::ranges::copy(polygon, footprint.corners.begin());
  return footprint;
}

}  // namespace penumbra::volumes
