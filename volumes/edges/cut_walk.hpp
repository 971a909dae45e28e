// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "volumes/edges/cut_ends.hpp"
#include "volumes/edges/edge_cut.hpp"
#include "volumes/edges/edge_set.hpp"

#include <cstdint>
#include <vector>

/// Cuts a hierarchy of edges at a light's plane: visits only parts that the plane cuts, for either engine. Inside
/// volumes/ only.
namespace penumbra::volumes {

/// Casters of a light, to be cut at its plane.
struct CutInput {
  const visibility::SceneFloats& scene;
  const visibility::TriangleTree& triangles;  ///< triangles of the scene
  const EdgeCasters& casters;
  std::int32_t without;  ///< the light whose body is excluded, or −1
  LightSide side;
  bool exact_ends = false;  ///< keeps the exact crossings with the plane, before rounding
};

enum class PlaneSide : std::uint8_t { in_front, behind, across };
/// Returns the side of the plane that an unscaled box is on. `in_front` and `behind` are certain; a box on one side may
/// be `across`, too, if it is closer to the plane than the rounding error.
PlaneSide place_of(const LightSide& side, const glm::dvec3& middle, const glm::dvec3& half);

/// Returns the casters whose boxes the plane may cut, in ascending order.
std::vector<std::uint32_t> triangles_across(const CutInput& input);

/// Removes from `tree` everything behind the plane and everything that the plane cuts; appends the parts of cut records
/// in front of it to `records`. `Tree` gives access to a hierarchy with eight children for each node and eight records
/// for each leaf. It must have roots(), reference(node, child) (TriangleTree::Child::reference), middle(node, child)
/// and half(node, child), both scaled, drop_child(node, child), has_record(leaf, slot), record(leaf, slot), not scaled,
/// and drop_record(leaf, slot).
template <typename Tree>
void cut_hierarchy(Tree& tree, const LightSide& side, CutEnds* ends, std::vector<EdgeRecord>& records) {
  using visibility::TriangleTree;
  const double unscaled = 1 / static_cast<double>(side.scale);
  const auto cut_leaf = [&](std::uint32_t leaf) {
    for (std::uint32_t slot = 0; slot < TriangleTree::kWidth; ++slot) {
      if (!tree.has_record(leaf, slot)) continue;
      EdgeRecord record = tree.record(leaf, slot);
      const glm::vec3 a = record.a, b = record.b;
      const bool kept = keep_in_front(record, side, ends);
      if (kept && record.cut == 0 && record.a == a && record.b == b) continue;
      tree.drop_record(leaf, slot);
      if (kept) records.push_back(record);
    }
  };
  std::vector<std::uint32_t> stack = tree.roots();
  while (!stack.empty()) {
    const std::uint32_t node = stack.back();
    stack.pop_back();
    for (std::uint32_t child = 0; child < TriangleTree::kWidth; ++child) {
      const std::uint32_t reference = tree.reference(node, child);
      if (reference == TriangleTree::kNoChild) continue;
      const PlaneSide place = place_of(side, glm::dvec3(tree.middle(node, child)) * unscaled,
                                       glm::dvec3(tree.half(node, child)) * unscaled);
      if (place == PlaneSide::behind) tree.drop_child(node, child);
      if (place != PlaneSide::across) continue;
      if ((reference & TriangleTree::kLeafBit) == 0) {
        stack.push_back(reference);
      } else {
        cut_leaf(reference & ~TriangleTree::kLeafBit);
      }
    }
  }
}

}  // namespace penumbra::volumes
