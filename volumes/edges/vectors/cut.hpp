// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engines/vectors/light_grid.hpp"
#include "engines/vectors/trees.hpp"
#include "volumes/edges/cut_ends.hpp"
#include "volumes/edges/cut_walk.hpp"
#include "volumes/edges/edge_tree.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

/// Edge scatter on a processor: edges for lights whose plane cuts them. Inside volumes/ only.
namespace penumbra::volumes {

/// Make a tree of all records of a scene, none of them flat, guided by the tree over its triangles; or a tree of any
/// records. Large trees make leaves on demand, so the scene must stay unchanged.
vectors::WideEdgeTree wide_edges(EdgeRecords records, const visibility::TriangleTree& triangles, float scale);
vectors::WideEdgeTree wide_edges(const std::vector<EdgeRecord>& records, float scale);
/// Edges of the previous frame, if there are any: leaves that have not moved are kept.
struct WideEdgesBefore {
  vectors::WideEdgeTree edges;
  LeafCones& cones;
};
/// Makes a tree of records along a tree over them (edge_tree). Flat records are marked as unused.
vectors::WideEdgeTree wide_edges(const EdgeRecords& records, const visibility::TriangleTree& tree, float scale,
                                 WideEdgesBefore before);

/// Position of an edge in a WideEdgeTree.
struct EdgeSlot {
  std::uint32_t leaf, lane;
};

/// A hierarchy of edges that is cut at a light's plane, and restored for the next light. Only parts that the plane cuts
/// are recomputed: subtrees behind it are excluded, and cut edges form a second tree.
class CutEdges {
 public:
  CutEdges() = default;
  explicit CutEdges(vectors::WideEdgeTree whole) : tree_(std::move(whole)) {}

  [[nodiscard]] const vectors::WideEdgeTree& tree() const { return tree_; }
  /// Returns the ends of edges with an index (WideEdges::cut); null if there are none.
  [[nodiscard]] const CutEnds* ends() const { return ends_ ? &*ends_ : nullptr; }
  /// Returns the index of the plane (SceneFloats::plane) that contains the light, if triangles lie in it: these are not
  /// between any p and the light.
  [[nodiscard]] std::uint32_t plane_of_light() const { return plane_of_light_; }
  /// Cuts the hierarchy. `without`: edges to exclude, since they do not belong to the casters.
  void cut(const CutInput& input, std::span<const EdgeSlot> without = {});
  /// Excludes these edges until restore().
  void leave_out(std::span<const EdgeSlot> slots);
  void restore();
  /// Moves the hierarchy out, restored to its state before any cut.
  [[nodiscard]] vectors::WideEdgeTree take() {
    restore();
    return std::move(tree_);
  }

 private:
  class Dropping;

  /// Saved usage mask of a node or a leaf.
  struct Used {
    std::uint32_t number, used;
  };
  vectors::WideEdgeTree tree_;
  std::optional<CutEnds> ends_;
  std::uint32_t plane_of_light_ = vectors::Cluster::kSeveral;
  bool is_cut_ = false;
  std::size_t roots_ = 0, nodes_count_ = 0;  // sizes of the uncut tree
  std::vector<Used> nodes_, leaves_;         // those that were changed
};

}  // namespace penumbra::volumes
