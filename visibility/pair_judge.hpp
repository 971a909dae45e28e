#pragma once

#include "visibility/light_samples.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/triangle_tree.hpp"
#include "visibility/view_samples.hpp"

#include <cstddef>
#include <cstdint>

namespace penumbra::visibility {

/// decide_pair along a hierarchy: for the pairs that a method's arithmetic leaves open. Exact.
struct PairJudge {
  const SceneFloats& scene;
  const TriangleTree& tree;
  const ViewSamples& samples;
  const Light& light;

  [[nodiscard]] bool meets(std::size_t pixel, const glm::vec3& l, std::uint32_t triangle) const {
    return may_occlude(scene, light, static_cast<std::uint32_t>(samples.triangle[pixel]), triangle) &&
           segment_meets_triangle(samples.p[pixel], l, scene.corners(triangle), light).meets;
  }
  /// How many triangles the segment to l meets.
  [[nodiscard]] std::uint32_t depth(std::size_t pixel, const glm::vec3& l) const {
    std::uint32_t met = 0;
    static_cast<void>(tree.any_along(samples.p[pixel], l, [&](std::uint32_t triangle) {
      met += meets(pixel, l, triangle) ? 1 : 0;
      return false;
    }));
    return met;
  }
  [[nodiscard]] bool is_visible(std::size_t pixel, const glm::vec3& l) const {
    const auto carrier = static_cast<std::uint32_t>(samples.triangle[pixel]);
    return above_horizon(scene.corners(carrier), samples.facing[pixel], l) &&
           in_front_of_light(light, samples.p[pixel]) &&
           !tree.any_along(samples.p[pixel], l, [&](std::uint32_t triangle) { return meets(pixel, l, triangle); });
  }
};

}  // namespace penumbra::visibility
