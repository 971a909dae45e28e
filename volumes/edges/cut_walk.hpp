#pragma once

#include "visibility/scene_floats.hpp"
#include "visibility/tree/triangle_tree.hpp"
#include "volumes/edges/cut_ends.hpp"
#include "volumes/edges/edge_cut.hpp"
#include "volumes/edges/edge_set.hpp"

#include <cstdint>
#include <vector>

/// A hierarchy of edges cut at a light's plane: only what the plane cuts is looked at, on either engine. Inside
/// volumes/ only.
namespace penumbra::volumes {

/// What casts shadow of a light, to be cut at its plane.
struct CutInput {
  const visibility::SceneFloats& scene;
  const visibility::TriangleTree& triangles;  ///< of the scene
  const EdgeCasters& casters;
  std::int32_t without;  ///< the light whose body is not among them, or −1
  LightSide side;
  bool exact_ends = false;  ///< keep where edges pass through the plane as it is before rounding
};

enum class PlaneSide : std::uint8_t { in_front, behind, across };
/// Of a box, not scaled. Certain of all but what is across: its corners are closer to the plane than rounding here can
/// be wrong.
PlaneSide place_of(const LightSide& side, const glm::dvec3& middle, const glm::dvec3& half);

/// Casters whose boxes the plane may cut, ascending.
std::vector<std::uint32_t> triangles_across(const CutInput& input);

/// Drops from `tree` what is behind the plane and what it cuts; `records` gets of the latter what is in front. `Tree`
/// says what a hierarchy is made of, eight children a node, eight records a leaf: roots(), reference(node, child)
/// (TriangleTree::Child::reference), middle(node, child) and half(node, child), scaled; drop_child(node, child);
/// has_record(leaf, slot), record(leaf, slot), not scaled; drop_record(leaf, slot).
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
