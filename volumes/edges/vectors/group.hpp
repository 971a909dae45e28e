// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/lights/light_touch.hpp"
#include "volumes/edges/cut_ends.hpp"
#include "volumes/edges/vectors/tables.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

/// Selects, from the lists of a cluster, the entries that affect a few neighbouring view samples. Inside volumes/ only.
namespace penumbra::volumes {

/// A cluster of view samples with the edges and triangles that may affect it.
struct ClusterInput {
  const LightGrid& grid;
  const visibility::LightTouch& touch;
  const WideEdgeTree& edge_tree;
  const WideTriangleTree& tree;
  const Cluster& cluster;
  std::span<const ClusterSample> samples;
  const EdgeTable& edges;
  const TriangleTable& triangles;
  std::size_t group;          ///< number of view samples that select edges together
  bool exact_area;            ///< computes an area of the light instead of light samples
  const CutEnds* ends;        ///< cut ends of the tree's edges (WideEdges::cut); null: no edge is cut
  std::uint32_t light_plane;  ///< CutEdges::plane_of_light

  /// Returns whether edges that cross no light row matter, too.
  [[nodiscard]] bool between_rows() const { return exact_area || grid.tiles; }
};
/// Sets the light samples of a view sample that are open from the start: those that a triangle touches.
void reset_open(const LightGrid& grid, const visibility::LightTouch& touch, const GridSample& at, Open& open);
/// Edges and triangles that affect a group of view samples. Settled edges stay well above all of its p.
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
