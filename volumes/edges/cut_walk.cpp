// SPDX-License-Identifier: Apache-2.0
// Conservative side of a box relative to a light's plane, and the triangles whose boxes the plane may cut.

#include "volumes/edges/cut_walk.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace penumbra::volumes {

using visibility::TriangleTree;

PlaneSide place_of(const LightSide& side, const glm::dvec3& middle, const glm::dvec3& half) {
  const glm::dvec3 n = side.sign * glm::cross(side.u, side.v), size = glm::abs(n), from = middle - side.center;
  const double spread = glm::dot(size, half);
  const double rounding = 0x1p-20 * glm::dot(size, glm::abs(middle) + half + glm::abs(side.center));
  const double height = glm::dot(n, from);
  if (height > spread + rounding) return PlaneSide::in_front;
  return height < -spread - rounding ? PlaneSide::behind : PlaneSide::across;
}

std::vector<std::uint32_t> triangles_across(const CutInput& in) {
  std::vector<std::uint32_t> found, stack;
  if (!in.triangles.nodes.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const TriangleTree::Node& node = in.triangles.nodes[stack.back()];
    stack.pop_back();
    for (const TriangleTree::Child& child : node) {
      if (child.reference == TriangleTree::kNoChild) continue;
      const glm::dvec3 lower(child.lower), upper(child.upper);
      if (place_of(in.side, 0.5 * (lower + upper), 0.5 * (upper - lower)) != PlaneSide::across) continue;
      if ((child.reference & TriangleTree::kLeafBit) == 0) {
        stack.push_back(child.reference);
        continue;
      }
      for (const std::uint32_t triangle : in.triangles.leaves[child.reference & ~TriangleTree::kLeafBit]) {
        if (triangle == TriangleTree::kNoTriangle) continue;
        if (in.without < 0 || in.scene.emits[triangle] != in.without) found.push_back(triangle);
      }
    }
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace penumbra::volumes
