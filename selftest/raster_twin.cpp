// SPDX-License-Identifier: Apache-2.0
// Computes the surfaces that any rasteriser must draw, in homogeneous coordinates: with corners A, B, C = (x, y, w)
// from the vertex shader, a texel's centre c = (x, y, 1) is covered where c · (B × C), c · (C × A) and c · (A × B) all
// have the sign of A · (B × C), and 1 / w there is c · (B × C + C × A + A × B) / A · (B × C) (Olano and Greer 1997).
//
// Errors. The shader computes x, y and w of a corner by five roundings each of the sum of its products' sizes; the
// division by w, the viewport and clipping add a few roundings of the coordinates. This moves the lines: to first order
// in each error, products of sizes and errors are summed. Then the corners are snapped: by a step in x and in y at
// most, in whatever direction the driver rounds. Every point of the snapped outline is within a step, in x and in y, of
// the outline before snapping. So the coverage of a texel is certain where the whole square of this half width around
// its centre is on one side of each edge. The driver's interpolated value at c is the plane's value at a point in this
// square; its own arithmetic adds roundings of the terms of the plane.

#include "selftest/raster_twin.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace penumbra::selftest {
namespace {

constexpr double kRounding = 0x1p-24;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Roundings of a sum of three products of differences.
constexpr double kTransform = 5;
/// Roundings of a coordinate in the transformation to the screen: division (2.5), viewport (2), clipping (4).
constexpr double kToScreen = 9;
/// Roundings of a driver's interpolation set-up: differences, products and a quotient of coordinates.
constexpr double kInterpolation = 32;
/// Multiple of the near distance within which the near plane may clip.
constexpr double kNearZone = 8;

struct Corner {
  glm::dvec3 at;     // x, y, w of the clip space
  glm::dvec3 error;  // of each coordinate
};

Corner transform(const maps::gpu::CasterPush& face, const glm::vec3& corner) {
  const glm::dvec3 d = glm::dvec3(corner) - glm::dvec3(face.point);
  Corner result{};
  const std::array rows{glm::dvec3(face.row_x), glm::dvec3(face.row_y), glm::dvec3(face.row_w)};
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3& row = rows.at(static_cast<std::size_t>(i));
    result.at[i] = glm::dot(row, d);
    result.error[i] = kTransform * kRounding * glm::dot(glm::abs(row), glm::abs(d));
  }
  for (int i = 0; i < 2; ++i) {
    result.error[i] += kToScreen * kRounding * (std::abs(result.at[i]) + std::abs(result.at.z));
  }
  return result;
}

/// Returns a bound of the error of a cross product, from the errors ea and eb of its vectors.
glm::dvec3 cross_error(const glm::dvec3& a, const glm::dvec3& ea, const glm::dvec3& b, const glm::dvec3& eb) {
  const auto component = [&](int i, int j) {
    return (std::abs(a[i]) + ea[i]) * eb[j] + ea[i] * std::abs(b[j]) + (std::abs(a[j]) + ea[j]) * eb[i] +
           ea[j] * std::abs(b[i]);
  };
  return {component(1, 2), component(2, 0), component(0, 1)};
}

}  // namespace

RasterTwin::RasterTwin(const maps::gpu::CasterPush& face, std::uint32_t size, double step,
                       std::span<const glm::vec3> corners)
    : size_(size), step_(2 * step / size), near_(static_cast<double>(face.near)), far_(static_cast<double>(face.far)) {
  for (std::size_t first = 0; first + 3 <= corners.size(); first += 3) {
    const std::array<Corner, 3> c{transform(face, corners[first]), transform(face, corners[first + 1]),
                                  transform(face, corners[first + 2])};
    Triangle t;
    t.plane = t.plane_error = glm::dvec3(0);
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner &a = c.at((i + 1) % 3), &b = c.at((i + 2) % 3);
      t.edge.at(i) = glm::cross(a.at, b.at);
      t.edge_error.at(i) = cross_error(a.at, a.error, b.at, b.error);
      t.snap.at(i) = step_ * (std::abs(t.edge.at(i).x) + std::abs(t.edge.at(i).y));
      t.plane += t.edge.at(i);
      const auto rounded = [](const Corner& corner) {
        return corner.error + kInterpolation * kRounding * (glm::abs(corner.at) + std::abs(corner.at.z));
      };
      t.plane_error += cross_error(a.at, rounded(a), b.at, rounded(b));
    }
    t.volume = glm::dot(c[0].at, t.edge[0]);
    t.volume_error =
        glm::dot(glm::abs(c[0].at) + c[0].error, t.edge_error[0]) + glm::dot(c[0].error, glm::abs(t.edge[0]));
    t.flat = std::abs(t.volume) <= t.volume_error;
    if (t.volume < 0) {
      for (glm::dvec3& edge : t.edge) edge = -edge;
      t.plane = -t.plane;
      t.volume = -t.volume;
    }
    t.boxed = std::ranges::all_of(c, [&](const Corner& corner) { return corner.at.z > kNearZone * near_; });
    if (t.boxed) {
      t.lower = glm::dvec2(kInfinity);
      t.upper = glm::dvec2(-kInfinity);
      for (const Corner& corner : c) {
        const double w = corner.at.z;
        const glm::dvec2 at = glm::dvec2(corner.at) / w,
                         off =
                             (glm::dvec2(corner.error) + glm::abs(at) * corner.error.z) / (w - corner.error.z) + step_;
        t.lower = glm::min(t.lower, at - off);
        t.upper = glm::max(t.upper, at + off);
      }
    }
    triangles_.push_back(t);
  }
}

void RasterTwin::find(std::uint32_t x, std::uint32_t y, std::vector<Surface>& surfaces) const {
  surfaces.clear();
  const glm::dvec3 c(2 * (x + 0.5) / size_ - 1, 2 * (y + 0.5) / size_ - 1, 1), size = glm::abs(c);
  for (std::size_t number = 0; number < triangles_.size(); ++number) {
    const Triangle& t = triangles_[number];
    if (t.boxed && (c.x < t.lower.x || c.y < t.lower.y || c.x > t.upper.x || c.y > t.upper.y)) continue;
    bool inside = !t.flat, outside = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const double distance = glm::dot(t.edge.at(i), c), margin = t.snap.at(i) + glm::dot(t.edge_error.at(i), size);
      inside = inside && distance > margin;
      outside = outside || (!t.flat && distance < -margin);
    }
    if (outside) continue;
    Surface surface;
    surface.sure = inside;
    surface.triangle = number;
    if (!t.flat) {
      const double q = glm::dot(t.plane, c) / t.volume;  // 1 / w
      const double slope = (std::abs(t.plane.x) + std::abs(t.plane.y)) / t.volume;
      const double off = step_ * slope + kInterpolation * kRounding * slope +
                         (glm::dot(t.plane_error, size) + std::abs(q) * t.volume_error) / t.volume;
      const double rounded = 4 * kRounding;  // of the shader's own division and product
      surface.depth = q > 0 ? 1 / (q * far_) : kInfinity;
      surface.low = q + off > 0 ? (1 - rounded) / ((q + off) * far_) : kInfinity;
      surface.high = q - off > 0 ? (1 + rounded) / ((q - off) * far_) : 1;
      if (q + off <= 0 || surface.low > 1) continue;  // behind the light point, or beyond all surfaces
      surface.sure = surface.sure && surface.low * far_ > kNearZone * near_ && surface.high < 1;
      if (surface.high * far_ < near_ / kNearZone) continue;
      surface.high = std::min(surface.high, 1.0);
    }
    surfaces.push_back(surface);
  }
}

namespace {

/// Judges `found` against the surfaces possibly behind `possible` and certainly behind `certain`; the found surface
/// must be behind `possible`.
Judged judge(std::span<const Surface> surfaces, double found, double possible, double certain, double nothing) {
  double limit = kInfinity;  // upper bound of the nearest depth
  for (const Surface& s : surfaces) {
    if (s.sure && s.low > certain) limit = std::min(limit, s.high);
  }
  Judged result;
  result.settled = true;
  double nearest = kInfinity;
  bool right = found == nothing && limit == kInfinity;
  for (const Surface& s : surfaces) {
    if (!(s.high > possible) || s.low > limit) continue;
    result.settled = result.settled && s.sure && s.low > certain;
    right = right || (found != nothing && found > possible && found >= s.low && found <= s.high && found <= limit);
    if (s.depth < nearest) {
      nearest = s.depth;
      result.allowed = std::max(s.high - s.depth, s.depth - s.low);
    }
  }
  result.right = right;
  if (limit == kInfinity) result.settled = result.settled && nearest == kInfinity;
  result.difference = nearest == kInfinity ? (found == nothing ? 0 : 1) : std::abs(found - nearest);
  return result;
}

std::vector<Surface> turned(std::span<const Surface> surfaces) {
  std::vector<Surface> result;
  for (const Surface& s : surfaces) result.push_back({-s.depth, -s.high, -s.low, s.sure});
  return result;
}

}  // namespace

Judged judge_nearest(std::span<const Surface> surfaces, double found) {
  return judge(surfaces, found, -kInfinity, -kInfinity, 1);
}

Judged judge_behind(std::span<const Surface> surfaces, double found, double previous) {
  const double behind = previous * (1 + 0x1p-20);
  return judge(surfaces, found, behind * (1 - 2 * kRounding), behind * (1 + 2 * kRounding), 1);
}

Judged judge_farthest(std::span<const Surface> surfaces, double found) {
  return judge(turned(surfaces), -found, -kInfinity, -kInfinity, -0.0);
}

double largest_disagreement(std::span<const Surface> surfaces, bool farthest) {
  const std::vector<Surface> all = farthest ? turned(surfaces) : std::vector<Surface>(surfaces.begin(), surfaces.end());
  double limit = kInfinity, first = kInfinity;
  for (const Surface& s : all) {
    if (s.sure) limit = std::min(limit, s.high);
  }
  for (const Surface& s : all) {
    if (s.low > limit) continue;
    if (!s.sure) return kInfinity;
    first = std::min(first, s.low);
  }
  return first == kInfinity ? 0 : limit - first;
}

}  // namespace penumbra::selftest
