#pragma once

#include "visibility/lights/light_touch.hpp"
#include "volumes/edges/cut_ends.hpp"
#include "volumes/edges/vectors/tables.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

/// A few neighbouring view samples sort out, together, what of their cluster's lists matters to them. Inside volumes/
/// only.
namespace penumbra::volumes {

/// A cluster of view samples with the edges and triangles that may matter to it.
struct ClusterInput {
  const LightGrid& grid;
  const visibility::LightTouch& touch;
  const WideEdgeTree& edge_tree;
  const WideTriangleTree& tree;
  const Cluster& cluster;
  std::span<const ClusterSample> samples;
  const EdgeTable& edges;
  const TriangleTable& triangles;
  std::size_t group;          ///< view samples that sort out edges together
  bool exact_area;            ///< not of light samples but of the light
  const CutEnds* ends;        ///< of edges of the tree (WideEdges::cut); null: none is cut
  std::uint32_t light_plane;  ///< CutEdges::plane_of_light

  /// Edges that cross no light row matter, too.
  [[nodiscard]] bool between_rows() const { return exact_area || grid.tiles; }
};
/// Sets what of a view sample is open before any caster is tested: light samples that a triangle touches.
void reset_open(const LightGrid& grid, const visibility::LightTouch& touch, const GridSample& at, Open& open);
/// What matters to a group of view samples. Settled edges stay well above all of its p.
struct GroupLists {
  GroupTable settled, unsettled;
  TriangleTable triangles;
};
void sort_out(const ClusterInput& input, std::span<const ClusterSample> group, GroupLists& lists);
/// Calls `visit(i)` for each view sample, with the lists of its group.
template <typename Visit>
void for_each_sample(const ClusterInput& input, GroupLists& lists, Visit visit) {
  for (std::size_t first = 0; first < input.samples.size(); first += input.group) {
    const auto group = input.samples.subspan(first, std::min(input.group, input.samples.size() - first));
    sort_out(input, group, lists);
    for (std::size_t i = first; i < first + group.size(); ++i) visit(i);
  }
}

}  // namespace penumbra::volumes
