// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/seen/box_tree.hpp"
#include "visibility/seen/placed_meshes.hpp"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace penumbra::visibility {

/// A ray in a space in which boxes are axis-aligned: the world, or a part's own.
struct TreeRay {
  static constexpr double kEndless = std::numeric_limits<double>::infinity();

  glm::dvec3 start, inverse;
  glm::dvec3 room;   ///< distance along each axis by which boxes are enlarged
  double pixel = 0;  ///< boxes are also enlarged by this share of their distance

  TreeRay(const glm::dvec3& from, const glm::dvec3& direction, const glm::dvec3& around, double pixels)
      : start(from), room(around), pixel(pixels) {
    // For a ray parallel to planes: a finite slope that moves all boxes beside the ray very far away.
    constexpr double kSteep = 1e200;
    for (int axis = 0; axis < 3; ++axis) {
      inverse[axis] = 1 / direction[axis];
      if (!(std::abs(inverse[axis]) < kSteep)) inverse[axis] = std::copysign(kSteep, inverse[axis]);
    }
  }

  /// Returns the parameter at which the ray enters the enlarged box; infinite if the ray misses.
  [[nodiscard]] double enter(const MiddleBox& box) const {
    const glm::dvec3 to = box.middle - start;
    const glm::dvec3 half = box.half + room + pixel * (sum_of_sides(to) + box.half.x + box.half.y + box.half.z);
    const glm::dvec3 one = (to - half) * inverse, other = (to + half) * inverse;
    const glm::dvec3 into = glm::min(one, other), out = glm::max(one, other);
    const double first = std::max({0.0, into.x, into.y, into.z}), last = std::min({out.x, out.y, out.z});
    return first <= last * (1 + 0x1p-40) ? first * (1 - 0x1p-40) : kEndless;
  }
};

/// Calls take(item) for the items of leaves whose boxes a ray enters up to `nearest`, nearest first; take() may lower
/// `nearest`; a value below 0 ends the walk. `enter`: parameter at which the ray enters a node's box.
template <typename Enter, typename Take>
void walk_nearest(const BoxTree& tree, const double& nearest, const Enter& enter, const Take& take) {
  struct Waiting {
    double enter;
    std::uint32_t node;
  };
  if (tree.empty()) return;
  std::array<Waiting, BoxTree::kDepth> stack;
  std::uint32_t top = 0;
  const auto wait = [&](std::uint32_t node, double at) {
    if (at <= nearest && at < TreeRay::kEndless) stack[top++] = {at, node};
  };
  wait(0, enter(tree.root().box));
  while (top > 0) {
    const Waiting waiting = stack[--top];
    if (waiting.enter > nearest) continue;
    const BoxTree::Node& node = tree.node(waiting.node);
    if (node.count > 0) {
      for (const std::uint32_t item : tree.items(node)) take(item);
      continue;
    }
    const std::uint32_t first = waiting.node + 1, second = node.first;
    const double at_first = enter(tree.node(first).box), at_second = enter(tree.node(second).box);
    if (at_first < at_second)
      wait(second, at_second), wait(first, at_first);
    else
      wait(first, at_first), wait(second, at_second);
  }
}

/// Calls take(triangle) for the triangles of a part whose leaves a ray of the world enters, as walk_nearest(). `around`
/// and `pixels`: as in TreeRay, in the world.
template <typename Take>
void walk_part(const PlacedMeshes::Part& part, const glm::dvec3& start, const glm::dvec3& direction, double around,
               double pixels, const double& nearest, const Take& take) {
  if (!part.has_own) {
    const TreeRay ray(start, direction, glm::dvec3(around), pixels);
    walk_nearest(
        *part.tree, nearest, [&](const MiddleBox& own) { return ray.enter(part.box(own)); }, take);
    return;
  }
  // In the part's own space, boxes need no transform. A distance d in the world is at most own_reach · d along each
  // axis there; distances to all of the part's boxes are at most `far`, and the rounding of the transform is less
  // than 2⁻³⁰ of them.
  const glm::dvec3 from = start - part.offset;
  const double far = sum_of_sides(part.in_world.middle - start) + 2 * sum_of_sides(part.in_world.half);
  const double room = around + pixels * far + part.room + 0x1p-30 * (sum_of_sides(from) + far);
  const TreeRay own(part.to_own * from, part.to_own * direction, part.own_reach * room, 0);
  walk_nearest(
      *part.tree, nearest, [&](const MiddleBox& box) { return own.enter(box); }, take);
}

}  // namespace penumbra::visibility
