// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "visibility/view_samples.hpp"

#include <glm/geometric.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace penumbra::visibility {

/// decide_pair with a hierarchy: for pairs that a method's arithmetic leaves open. Exact.
struct PairJudge {
  const SceneFloats& scene;
  const TriangleTree& tree;
  const ViewSamples& samples;
  const Light& light;

  [[nodiscard]] bool meets(std::size_t pixel, const glm::vec3& l, std::uint32_t triangle) const {
    return may_occlude(scene, light, static_cast<std::uint32_t>(samples.triangle[pixel]), triangle) &&
           segment_meets_triangle(samples.p[pixel], l, scene.corners(triangle), light).meets;
  }
  /// Returns the number of triangles that the segment to l meets.
  [[nodiscard]] std::uint32_t depth(std::size_t pixel, const glm::vec3& l) const {
    std::uint32_t met = 0;
    static_cast<void>(any_along(pixel, l, [&](std::uint32_t triangle) {
      met += meets(pixel, l, triangle) ? 1 : 0;
      return false;
    }));
    return met;
  }
  /// Returns the number of triangles that the segment to the exact point centre + s u + t v of the light's plane meets:
  /// a triangle counts where it is strictly between p and that plane. Returns nullopt if double does not determine the
  /// triangles to test (SegmentInBox).
  [[nodiscard]] std::optional<std::uint32_t> depth_in_plane(std::size_t pixel, const glm::dvec2& st) const {
    const PlanePoint l(light, st);
    const glm::dvec3 p(samples.p[pixel]);
    if (!(glm::length(l.rounded - p) > 0x1p8 * 0x1p32 * l.off)) return std::nullopt;
    std::uint32_t met = 0;
    static_cast<void>(tree.any_along(p, l.rounded, [&](std::uint32_t triangle) {
      if (may_occlude(scene, light, static_cast<std::uint32_t>(samples.triangle[pixel]), triangle))
        met += meets_before_light(samples.p[pixel], l, scene.corners(triangle), light) ? 1 : 0;
      return false;
    }));
    return met;
  }
  [[nodiscard]] bool is_visible(std::size_t pixel, const glm::vec3& l) const {
    const auto carrier = static_cast<std::uint32_t>(samples.triangle[pixel]);
    return above_horizon(light, scene.corners(carrier), samples.facing[pixel], l) &&
           in_front_of_light(light, samples.p[pixel]) &&
           !any_along(pixel, l, [&](std::uint32_t triangle) { return meets(pixel, l, triangle); });
  }

 private:
  template <typename Visit>
  bool any_along(std::size_t pixel, const glm::vec3& l, Visit&& visit) const {
    const glm::dvec3 p(samples.p[pixel]);
    if (light.sun) return tree.any_along_ray(p, glm::dvec3(l), visit);
    return tree.any_along(p, glm::dvec3(l), visit);
  }
};

}  // namespace penumbra::visibility
