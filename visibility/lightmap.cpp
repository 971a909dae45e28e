// SPDX-License-Identifier: Apache-2.0
// Texels of a lightmap as view samples: the triangle that covers a texel's centre in the map gives the sample's place
// on the surface.

#include "visibility/lightmap.hpp"

#include "base/assert.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace penumbra::visibility {
namespace {

/// Returns twice the signed area of (a, b, c), with the same sign for both triangles at the edge a b.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  if (std::pair(b.x, b.y) < std::pair(a.x, a.y)) return -turn(b, a, c);
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_place(const glm::dvec2& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

/// The texels from `first` to `last` whose centres may lie between two coordinates.
struct TexelRange {
  std::int64_t first, last;
};
TexelRange range_of(double low, double high, std::uint32_t size) {
  const double most = size - 1.0;
  return {static_cast<std::int64_t>(std::clamp(std::floor(low * size - 0.5), 0.0, most)),
          static_cast<std::int64_t>(std::clamp(std::ceil(high * size - 0.5), 0.0, most))};
}

/// Returns whether the stored corners, which are sorted, have the soup's cyclic order.
bool same_order(const Triangle& stored, const mesh::Triangle& soup) {
  const auto first = static_cast<std::size_t>(std::ranges::find(soup, stored[0]) - soup.begin());
  return soup[(first + 1) % 3] == stored[1];
}

}  // namespace

ViewSamples surface_view_samples(const SceneFloats& scene, std::span<const mesh::Triangle> soup,
                                 const PinholeCamera& camera, std::span<const SurfacePoint> points, SurfaceSide side) {
  PENUMBRA_ASSERT(points.size() == std::size_t{camera.width} * camera.height, "{} points for {} × {} samples",
                  points.size(), camera.width, camera.height);
  ViewSamples samples;
  samples.width = camera.width;
  samples.height = camera.height;
  samples.camera = camera;
  samples.eye = glm::vec3(camera.eye);
  samples.triangle.assign(points.size(), ViewSamples::kBackground);
  samples.p.assign(points.size(), glm::vec3(0));
  samples.n.assign(points.size(), glm::vec3(0));
  samples.depth.assign(points.size(), 0);
  samples.facing.assign(points.size(), 0);
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    if (points[i].triangle == ViewSamples::kBackground) return;
    const auto number = static_cast<std::uint32_t>(points[i].triangle);
    if (scene.plane[number] == SceneFloats::kNoPlane) return;
    glm::dvec3 p(0);
    for (std::size_t k = 0; k < 3; ++k)
      p += points[i].shares[static_cast<glm::length_t>(k)] * glm::dvec3(scene.positions[soup[number][k]]);
    const std::array<glm::vec3, 3> corners = scene.corners(number);
    const bool front = same_order(scene.triangles[number], soup[number]);
    samples.triangle[i] = points[i].triangle;
    samples.p[i] = glm::vec3(p) + 0.0f;
    samples.facing[i] = front == (side == SurfaceSide::front) ? std::int8_t{1} : std::int8_t{-1};
    const mesh::SidesOfPlane sides(corners[0], corners[1], corners[2]);
    samples.n[i] = glm::vec3(glm::normalize(sides.normal() * static_cast<double>(samples.facing[i]))) + 0.0f;
    samples.depth[i] = static_cast<float>(glm::dot(camera.forward, glm::dvec3(samples.p[i]) - camera.eye));
  });
  return samples;
}

TexelPoints texel_points(std::span<const mesh::Triangle> soup, std::span<const std::uint32_t> triangles,
                         std::span<const glm::dvec2> places, std::uint32_t width, std::uint32_t height) {
  TexelPoints texels;
  texels.points.resize(std::size_t{width} * height);
  for (const std::uint32_t number : triangles) {
    std::array<glm::dvec2, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = places[soup[number][k]];
    const auto& [a, b, c] = corners;
    const double area = is_place(a) && is_place(b) && is_place(c) ? turn(a, b, c) : 0;
    if (area == 0 || !std::isfinite(area)) {
      ++texels.unmapped;
      continue;
    }
    const double orientation = area > 0 ? 1 : -1;
    const glm::dvec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    if (low.x < 0 || low.y < 0 || high.x > 1 || high.y > 1) ++texels.outside;
    if (high.x < 0 || high.y < 0 || low.x > 1 || low.y > 1) continue;
    const TexelRange columns = range_of(low.x, high.x, width), rows = range_of(low.y, high.y, height);
    for (std::int64_t y = rows.first; y <= rows.last; ++y) {
      for (std::int64_t x = columns.first; x <= columns.last; ++x) {
        const glm::dvec2 center((static_cast<double>(x) + 0.5) / width, (static_cast<double>(y) + 0.5) / height);
        const glm::dvec3 parts = orientation * glm::dvec3(turn(b, c, center), turn(c, a, center), turn(a, b, center));
        if (parts.x < 0 || parts.y < 0 || parts.z < 0) continue;
        const double sum = parts.x + parts.y + parts.z;
        if (!(sum > 0)) continue;
        SurfacePoint& point = texels.points[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
        if (point.triangle != ViewSamples::kBackground) {
          if (parts.x > 0 && parts.y > 0 && parts.z > 0) ++texels.overlaps;
          continue;
        }
        point = {static_cast<std::int32_t>(number), parts / sum};
        ++texels.covered;
      }
    }
  }
  return texels;
}

std::vector<std::int64_t> margin_sources(std::span<const SurfacePoint> points, std::uint32_t width,
                                         std::uint32_t margin) {
  std::vector<std::int64_t> sources(points.size(), -1);
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].triangle == ViewSamples::kBackground) continue;
    sources[i] = static_cast<std::int64_t>(i);
    front.push_back(i);
  }
  const auto columns = static_cast<std::int64_t>(width), rows = static_cast<std::int64_t>(points.size() / width);
  for (std::uint32_t step = 0; step < margin && !front.empty(); ++step) {
    std::vector<std::size_t> next;
    // Neighbours in rows and columns are nearer than diagonal ones.
    const auto spread = [&](const std::array<std::pair<int, int>, 4>& directions) {
      for (const std::size_t i : front) {
        const std::int64_t x = static_cast<std::int64_t>(i) % columns, y = static_cast<std::int64_t>(i) / columns;
        for (const auto& [dx, dy] : directions) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= columns || y + dy >= rows) continue;
          const auto neighbour = static_cast<std::size_t>((y + dy) * columns + x + dx);
          if (sources[neighbour] >= 0) continue;
          sources[neighbour] = sources[i];
          next.push_back(neighbour);
        }
      }
    };
    spread({{{0, -1}, {-1, 0}, {1, 0}, {0, 1}}});
    spread({{{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}});
    front = std::move(next);
  }
  return sources;
}

}  // namespace penumbra::visibility
