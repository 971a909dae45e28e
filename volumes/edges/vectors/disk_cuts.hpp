// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/vectors/tables.hpp"

#include <glm/vec2.hpp>

#include <array>

/// Cuts of casters by a sphere's disk, as one view sample sees it. Only objects in front of the disk hide light
/// samples, so each caster that passes through the disk has one more edge there. docs/edge-scatter.md, "Ends". Inside
/// volumes/ only.
namespace penumbra::volumes {

struct DiskCutInput {
  const LightGrid& grid;
  const ClusterSample& at;
};
/// Adds these edges (kEdge: kDiskCut) to a table of crossings. All light samples within an edge's error are open. Edges
/// with k = 0 change nothing, but are added, too, since rounding may hide another k.
void add_disk_cuts(const DiskCutInput& input, OpenJudge& judge, Open& open, CrossingTable& out);

/// Which ends of a mesh's edge are behind the disk, and where the edge crosses its plane.
struct PassingEdge {
  std::array<bool, 2> behind{};
  glm::vec2 place{0};  ///< place of the crossing, if there is one
  float share = 0;     ///< fraction of the edge from a to b
};
PassingEdge pass_disk(const DiskCutInput& input, const std::array<glm::dvec3, 2>& ends);

}  // namespace penumbra::volumes
