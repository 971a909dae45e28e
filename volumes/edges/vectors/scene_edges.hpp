#pragma once

#include "volumes/edges/vectors/cut.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

/// Inside volumes/ only.
namespace penumbra::volumes {

/// What scene edges are made of.
struct SceneMesh {
  const visibility::SceneFloats& scene;
  const visibility::TriangleTree& triangles;  ///< over its casters
  const EdgeCasters& casters;                 ///< all of them
  float scale;
};

/// All edges of a scene, for walks on vector units. Of a frame that comes of another by moving, what does not move with
/// vertices is kept: who shares an edge with whom, and who hangs below whom. Planes, boxes, cones and leaves are made
/// anew, since all of them are of floats that were rounded after the movement: those of an object that has only been
/// moved or turned are other floats, too. docs/frames.md.
class SceneEdges {
 public:
  void expect_frames() { keeps_ = true; }

  enum class Made : std::uint8_t {
    built,
    tree_built,  ///< the same edges, but some that were flat are not, or the old hierarchy fitted badly
    refit,
  };
  Made make(const SceneMesh& mesh);

  [[nodiscard]] CutEdges& edges() { return edges_; }
  [[nodiscard]] const CutEdges& edges() const { return edges_; }
  /// Which of them go where the body of this light does not cast. Nothing: its triangles are grown together with
  /// others, by an edge or by a plane, so that these have other edges without it.
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
  std::map<std::int32_t, Body> bodies_;  // of lights
  // Where frames are expected:
  std::optional<EdgeRecords> records_;
  visibility::TriangleTree tree_;
  UnsetList<NormalCone> cones_;  // of its leaves
  double built_cost_ = 0;
  float scale_ = 0;
};

}  // namespace penumbra::volumes
