#pragma once

#include "volumes/edges/vectors/tables.hpp"

#include <glm/vec2.hpp>

#include <array>

/// What a sphere's disk, as one view sample sees it, cuts casters into: only what is before the disk hides light
/// samples, so each caster that passes through it has one more edge there. docs/edge-scatter.md, "Ends". Inside
/// volumes/ only.
namespace penumbra::volumes {

struct DiskCutInput {
  const LightGrid& grid;
  const ClusterSample& at;
};
/// Adds these edges (kEdge: kDiskCut) to a table of crossings. All light samples within their errors are open. Those of
/// k 0 cut nothing, but rounding may see it otherwise.
void add_disk_cuts(const DiskCutInput& input, OpenJudge& judge, Open& open, CrossingTable& out);

/// Which ends of a mesh's edge are behind the disk, and where it passes through.
struct PassingEdge {
  std::array<bool, 2> behind{};
  glm::vec2 place{0};  ///< if one is
  float share = 0;     ///< of the way from a to b
};
PassingEdge pass_disk(const DiskCutInput& input, const std::array<glm::dvec3, 2>& ends);

}  // namespace penumbra::volumes
