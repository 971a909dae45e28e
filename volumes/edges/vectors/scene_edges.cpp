// SPDX-License-Identifier: Apache-2.0
// Edges of a scene for vector units: made, refit for the next frame, and attributed to lights' bodies.

#include "volumes/edges/vectors/scene_edges.hpp"

#include "base/parallel.hpp"
#include "visibility/tree/tree_refit.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace penumbra::volumes {
namespace {

using visibility::TriangleTree;

visibility::Bounds box_of(const EdgeRecords& records, std::uint32_t record) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  return records.is_flat(record) ? visibility::Bounds{glm::vec3(kFar), glm::vec3(-kFar)} : records.box(record);
}

}  // namespace

SceneEdges::Made SceneEdges::make(const SceneMesh& mesh) {
  if (!keeps_) {
    edges_ = CutEdges(wide_edges(EdgeRecords(mesh.scene, mesh.casters), mesh.triangles, mesh.scale));
    find_bodies(mesh);
    return Made::built;
  }
  const auto followed = records_ ? records_->follow(mesh.scene, mesh.casters) : EdgeRecords::Followed::nothing;
  if (followed == EdgeRecords::Followed::nothing) records_.emplace(mesh.scene, mesh.casters, EdgeRecords::Flat::kept);
  Made made = followed == EdgeRecords::Followed::nothing ? Made::built : Made::tree_built;
  const bool scaled = std::exchange(scale_, mesh.scale) != mesh.scale;
  const auto has_moved = [&](std::size_t leaf) {
    return scaled || std::ranges::any_of(tree_.leaves[leaf], [&](std::uint32_t record) {
             return record != TriangleTree::kNoTriangle && records_->has_moved(record);
           });
  };
  if (followed == EdgeRecords::Followed::all) {
    visibility::refit_tree(
        tree_, [&](std::uint32_t record) { return box_of(*records_, record); }, has_moved);
    if (visibility::tree_cost(tree_) <= visibility::kMostGrowth * built_cost_) made = Made::refit;
  }
  vectors::WideEdgeTree before;
  if (made == Made::refit) {
    before = edges_.take();
  } else {
    edges_ = {};
    tree_ = edge_tree(*records_, mesh.triangles);
    built_cost_ = visibility::tree_cost(tree_);
    cones_.clear();
  }
  LeafCones cones{std::move(cones_), has_moved};
  edges_ = CutEdges(wide_edges(*records_, tree_, mesh.scale, {std::move(before), cones}));
  cones_ = std::move(cones.cones);
  find_bodies(mesh);
  return made;
}

/// Coplanar triangles take their plane from the largest of them (plane_of). If that triangle belongs to a body, the
/// others have another plane without the body. A plane's owner is that of its largest triangle, provided that the plane
/// is not shared.
void SceneEdges::find_bodies(const SceneMesh& mesh) {
  bodies_.clear();
  const std::vector<std::int32_t>& emits = mesh.scene.emits;
  if (std::ranges::none_of(emits, [](std::int32_t light) { return light >= 0; })) return;
  const auto owner = [&](std::uint32_t plane) {
    return plane == visibility::SceneFloats::kNoPlane ? -1 : emits[mesh.casters.largest_in_plane[plane]];
  };
  for (const std::uint32_t triangle : mesh.casters.triangle) {
    const std::int32_t light = owner(mesh.scene.plane[triangle]);
    if (emits[triangle] == light) continue;
    for (const std::int32_t one : {light, emits[triangle]}) {
      if (one >= 0) bodies_[one].grown_together = true;
    }
  }
  const vectors::WideLeaves<vectors::WideEdges>& leaves = edges_.tree().leaves;
  // This loop makes all leaves, on all cores.
  for_each_index(leaves.size(), [&](std::size_t i) { static_cast<void>(leaves[i]); });
  for (std::uint32_t leaf = 0; leaf < leaves.size(); ++leaf) {
    for (std::uint32_t used = leaves[leaf].used; used != 0; used &= used - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(used));
      const std::uint32_t first = leaves[leaf].plane[0][lane], second = leaves[leaf].plane[1][lane];
      const std::int32_t one = owner(first), other = second == visibility::SceneFloats::kNoPlane ? one : owner(second);
      if (one >= 0) bodies_[one].slots.push_back({leaf, lane});
      if (one == other) continue;
      for (const std::int32_t light : {one, other}) {
        if (light >= 0) bodies_[light].grown_together = true;
      }
    }
  }
}

std::optional<std::span<const EdgeSlot>> SceneEdges::of_body(std::int32_t light) const {
  const auto body = bodies_.find(light);
  if (body == bodies_.end()) return std::span<const EdgeSlot>();
  if (body->second.grown_together) return std::nullopt;
  return body->second.slots;
}

std::uint64_t SceneEdges::memory_bytes() const {
  const std::uint64_t edges = vectors::bytes_of(edges_.tree());
  if (!records_) return edges;
  return edges + vectors::bytes_of(tree_) + cones_.size() * sizeof(NormalCone) + records_->memory_bytes();
}

}  // namespace penumbra::volumes
