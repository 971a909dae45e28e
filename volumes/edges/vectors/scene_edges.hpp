// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/vectors/cut.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

/// Inside volumes/ only.
namespace penumbra::volumes {

/// Input of scene edges.
struct SceneMesh {
  const visibility::SceneFloats& scene;
  const visibility::TriangleTree& triangles;  ///< over the scene's casters
  const EdgeCasters& casters;                 ///< all casters
  float scale;
};

/// All edges of a scene, for traversals on vector units. In animations, topology (edge adjacency, tree structure) is
/// reused; planes, boxes, cones and leaves are recomputed, since they derive from floats that were rounded after the
/// movement, which differ even for an object that was only translated or rotated. docs/frames.md.
class SceneEdges {
 public:
  void expect_frames() { keeps_ = true; }

  enum class Made : std::uint8_t {
    built,
    tree_built,  ///< the edges are the same, but some that were flat are not flat now, or the old hierarchy fitted
                 ///< badly
    refit,
  };
  Made make(const SceneMesh& mesh);

  [[nodiscard]] CutEdges& edges() { return edges_; }
  [[nodiscard]] const CutEdges& edges() const { return edges_; }
  /// Returns the edges to exclude if the body of this light casts no shadow; nullopt if its triangles share an edge or
  /// a plane with others, which then have other edges without the body.
  [[nodiscard]] std::optional<std::span<const EdgeSlot>> of_body(std::int32_t light) const;
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  void find_bodies(const SceneMesh& mesh);

  bool keeps_ = false;
  CutEdges edges_;
  struct Body {
    std::vector<EdgeSlot> slots;
    bool grown_together = false;
  };
  std::map<std::int32_t, Body> bodies_;  // for each light
  // Kept if more frames are expected:
  std::optional<EdgeRecords> records_;
  visibility::TriangleTree tree_;
  UnsetList<NormalCone> cones_;  // cones of tree_'s leaves
  double built_cost_ = 0;
  float scale_ = 0;
};

}  // namespace penumbra::volumes
