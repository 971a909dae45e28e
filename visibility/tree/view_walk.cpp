// SPDX-License-Identifier: Apache-2.0
// View samples (visibility/view_samples.hpp) by traversal of a tree. A pixel that cover() gives to a triangle because
// of rounding is outside of the triangle by less than a pixel, as rasterisers assume, too
// (render/visibility_buffer.vert): boxes are enlarged by that much.

#include "visibility/tree/view_walk.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>

namespace penumbra::visibility {
namespace {

Bounds box_around(const SceneFloats& scene, const PinholeCamera& camera, std::uint32_t triangle) {
  const auto [a, b, c] = scene.corners(triangle);
  const glm::vec3 lower = glm::min(a, glm::min(b, c)), upper = glm::max(a, glm::max(b, c));
  const glm::dvec3 far = glm::max(glm::abs(glm::dvec3(lower) - camera.eye), glm::abs(glm::dvec3(upper) - camera.eye));
  const double away = glm::length(far) + (camera.lens ? camera.lens->radius : 0);
  const double half = camera.half_height ? *camera.half_height : camera.tan_half_fov * away;
  // Size of a pixel at that distance, and the rounding of the sum to float.
  const double pixel =
      2 * half / camera.picture_height() + 0x1p-22 * glm::length(glm::max(glm::abs(lower), glm::abs(upper)));
  const auto pad = static_cast<float>(std::min(pixel, 0x1p100));
  return {lower - pad, upper + pad};
}

TriangleTree tree_for(const SceneFloats& scene, const PinholeCamera& camera, std::span<const std::uint32_t> triangles) {
  std::vector<Bounds> boxes;
  boxes.reserve(triangles.size());
  for (const std::uint32_t triangle : triangles) boxes.push_back(box_around(scene, camera, triangle));
  return make_tree_over(boxes);
}

/// The part of space that a rectangle of pixels sees: in front of the four planes through its sides.
class SeenThrough {
 public:
  SeenThrough(const PinholeCamera& camera, std::span<const std::uint32_t> pixels) {
    std::uint32_t left = camera.width, top = camera.height, right = 0, bottom = 0;
    for (const std::uint32_t pixel : pixels) {
      const std::uint32_t x = pixel % camera.width, y = pixel / camera.width;
      left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
    }
    // One more pixel if there is one, so that the planes differ.
    left -= left > 0 ? 1 : 0, top -= top > 0 ? 1 : 0, ++right, ++bottom;
    const std::array corners{camera.ray(left, top), camera.ray(right, top), camera.ray(right, bottom),
                             camera.ray(left, bottom)};
    const glm::dvec3 inside = 0.5 * (corners[0].start + corners[2].start + corners[0].direction + corners[2].direction);
    for (std::size_t i = 0; i < 4; ++i) {
      const ViewRay &a = corners[i], &b = corners[(i + 1) % 4];
      Plane& plane = planes_[i];
      plane.at = a.start;
      plane.n = glm::cross(a.direction, b.start - a.start + b.direction);
      if (glm::dot(plane.n, inside - a.start) < 0) plane.n = -plane.n;
    }
  }

  /// Returns false only for boxes certainly outside; boxes are enlarged by a pixel, which exceeds double rounding.
  [[nodiscard]] bool may_meet(const Bounds& box) const {
    const glm::dvec3 middle = 0.5 * (glm::dvec3(box.lower) + glm::dvec3(box.upper)),
                     half = 0.5 * (glm::dvec3(box.upper) - glm::dvec3(box.lower));
    return std::ranges::all_of(planes_, [&](const Plane& plane) {
      return !(glm::dot(plane.n, middle - plane.at) + glm::dot(glm::abs(plane.n), half) < 0);
    });
  }

 private:
  struct Plane {
    glm::dvec3 at{0}, n{0};
  };
  std::array<Plane, 4> planes_;
};

/// Completes view samples; pixels without a hit keep the background.
ViewSamples complete(const SceneFloats& scene, const PinholeCamera& camera, const ViewWalk& walk,
                     std::span<const std::uint32_t> pixels, std::vector<std::int32_t> carriers) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      carriers[pixels[i]] = walk.carrier(pixels[i] % camera.width, pixels[i] / camera.width);
  });
  return complete_view_samples(scene, camera, std::move(carriers));
}

}  // namespace

ViewWalk::ViewWalk(const SceneFloats& scene, const PinholeCamera& camera, std::vector<std::uint32_t> triangles)
    : scene_(scene), camera_(camera), triangles_(std::move(triangles)), tree_(tree_for(scene, camera, triangles_)) {}

void ViewWalk::meet(std::uint32_t x, std::uint32_t y, std::vector<Met>& met) const {
  met.clear();
  const ViewRay ray = camera_.ray(x, y);
  tree_.for_each_in(RayInBox(ray.start, ray.direction), [&](std::uint32_t i) {
    const std::uint32_t triangle = triangles_[i];
    if (const std::optional<double> t = cover(ray, scene_.corners(triangle))) met.push_back({*t, triangle});
  });
  // The first in the file wins among triangles with equal corners.
  std::ranges::sort(met, [&](const Met& a, const Met& b) {
    if (a.t != b.t) return a.t < b.t;
    if (scene_.comes_before(a.triangle, b.triangle)) return true;
    return !scene_.comes_before(b.triangle, a.triangle) && a.triangle < b.triangle;
  });
}

std::int32_t ViewWalk::carrier(std::uint32_t x, std::uint32_t y) const {
  std::vector<Met> met;
  meet(x, y, met);
  const ViewRay ray = camera_.ray(x, y);
  const auto carrier = std::ranges::find_if(met, [&](const Met& one) { return may_carry(scene_, one.triangle, ray); });
  return carrier == met.end() ? ViewSamples::kBackground : static_cast<std::int32_t>(carrier->triangle);
}

std::vector<std::uint32_t> triangles_with_area(const SceneFloats& scene) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.plane[i] != SceneFloats::kNoPlane) triangles.push_back(i);
  }
  return triangles;
}

ViewSamples walk_view_samples(const SceneFloats& scene, const PinholeCamera& camera) {
  std::vector<std::uint32_t> all(std::size_t{camera.width} * camera.height);
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  const ViewWalk walk(scene, camera, triangles_with_area(scene));
  return complete(scene, camera, walk, all, std::vector<std::int32_t>(all.size(), ViewSamples::kBackground));
}

ViewSamples look_through(const SceneFloats& scene, const PinholeCamera& camera, ViewSamples solid) {
  if (scene.alphas.empty()) return solid;
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t i = 0; i < solid.size(); ++i) {
    if (solid.triangle[i] == ViewSamples::kBackground) continue;
    const ViewRay ray = camera.ray(i % camera.width, i / camera.width);
    if (!may_carry(scene, static_cast<std::uint32_t>(solid.triangle[i]), ray)) pixels.push_back(i);
  }
  if (pixels.empty()) return solid;
  std::vector<std::uint32_t> triangles = triangles_with_area(scene);
  const SeenThrough seen(camera, pixels);
  std::erase_if(triangles, [&](std::uint32_t triangle) { return !seen.may_meet(box_around(scene, camera, triangle)); });
  return complete(scene, camera, ViewWalk(scene, camera, std::move(triangles)), pixels, std::move(solid.triangle));
}

}  // namespace penumbra::visibility
