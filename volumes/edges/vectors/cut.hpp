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

/// Of all records of a scene, none of them flat, along the tree over its triangles: leaves of many are made when
/// somebody asks for them, so the scene must stay as it is. Or of any records.
vectors::WideEdgeTree wide_edges(EdgeRecords records, const visibility::TriangleTree& triangles, float scale);
vectors::WideEdgeTree wide_edges(const std::vector<EdgeRecord>& records, float scale);
/// What there was for the frame before: leaves, if there are any, of which those that have not moved stay.
struct WideEdgesBefore {
  vectors::WideEdgeTree edges;
  LeafCones& cones;
};
/// Of records in a tree that is theirs (edge_tree). Those that are flat are not in use.
vectors::WideEdgeTree wide_edges(const EdgeRecords& records, const visibility::TriangleTree& tree, float scale,
                                 WideEdgesBefore before);

/// An edge in a WideEdgeTree.
struct EdgeSlot {
  std::uint32_t leaf, lane;
};

/// A hierarchy of edges that is cut at a light's plane, and restored for the next light. Only what the plane cuts is
/// computed again: subtrees behind it are left out, the cut edges are a second tree beside the first.
class CutEdges {
 public:
  CutEdges() = default;
  explicit CutEdges(vectors::WideEdgeTree whole) : tree_(std::move(whole)) {}

  [[nodiscard]] const vectors::WideEdgeTree& tree() const { return tree_; }
  /// Of edges with a number (WideEdges::cut); null: none has.
  [[nodiscard]] const CutEnds* ends() const { return ends_ ? &*ends_ : nullptr; }
  /// The number of the plane (SceneFloats::plane) that the light lies in, if triangles lie in it: they are not
  /// between any p and the light.
  [[nodiscard]] std::uint32_t plane_of_light() const { return plane_of_light_; }
  /// `without`: edges of what is not among the casters.
  void cut(const CutInput& input, std::span<const EdgeSlot> without = {});
  /// Leaves some out, until restore().
  void leave_out(std::span<const EdgeSlot> slots);
  void restore();
  /// Gives it away, as it was before anything was cut.
  [[nodiscard]] vectors::WideEdgeTree take() {
    restore();
    return std::move(tree_);
  }

 private:
  class Dropping;

  /// What a node or a leaf had in use.
  struct Used {
    std::uint32_t number, used;
  };
  vectors::WideEdgeTree tree_;
  std::optional<CutEnds> ends_;
  std::uint32_t plane_of_light_ = vectors::Cluster::kSeveral;
  bool is_cut_ = false;
  std::size_t roots_ = 0, nodes_count_ = 0;  // of the whole
  std::vector<Used> nodes_, leaves_;         // that were changed
};

}  // namespace penumbra::volumes
