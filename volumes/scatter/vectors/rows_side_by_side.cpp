// SPDX-License-Identifier: Apache-2.0
// rows=exact: places the edges of one view sample on vector units, except those that need special treatment.

#include "volumes/scatter/vectors/rows.hpp"

#include <bit>
#include <cmath>
#include <optional>

namespace penumbra::volumes {

PlacesFrame RowSum::frame() const {
  return {p_,
          axes_,
          foot_,
          glm::dvec2(grid_.half_cells),
          {grid_.columns, grid_.rows},
          height_,
          per_length_,
          skew_,
          error_foot_,
          error_height_,
          grid_.cones && grid_.cones->end};
}

void RowSum::add(const CrossingTable& crossing, const ClusterInput& of) {
  const PlacesFrame here = frame();
  places_.count = 0;
  for (std::size_t i = 0; i < crossing.count && !is_open_; ++i) {
    const std::uint32_t edge = std::bit_cast<std::uint32_t>(crossing[kEdge][i]) & ~kUnsettled;
    const auto slot = std::bit_cast<std::uint32_t>(of.edges[kEdgeSlot][edge]);
    const WideEdges& leaf = of.edge_tree.leaves[slot / kWide];
    const std::size_t lane = slot % kWide;
    const float k = crossing[kK][i];
    if (std::isnan(k) || (leaf.cut[lane] != 0 && of.ends != nullptr)) {
      add(place(leaf, lane, of.ends, std::isnan(k) ? std::nullopt : std::optional(static_cast<int>(k))));
      continue;
    }
    const std::size_t at = places_.count++;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      places_.a[axis][at] = static_cast<double>(leaf.a[axis][lane]);
      places_.b[axis][at] = static_cast<double>(leaf.b[axis][lane]);
    }
    places_.k[at] = static_cast<std::int32_t>(k);
    places_.slot[at] = slot;
    if (places_.count == WidePlaces::kMost) add_side_by_side(here, of);
  }
  add_side_by_side(here, of);
}

void RowSum::add_side_by_side(const PlacesFrame& here, const ClusterInput& of) {
  place_side_by_side(here, places_);
  for (std::size_t i = 0; i < places_.count && !is_open_; ++i) {
    const WidePlaces::How how = places_.how[i];
    if (how == WidePlaces::kBeside) continue;
    if (how == WidePlaces::kUnplaced) {
      const std::uint32_t slot = places_.slot[i];
      add(place(of.edge_tree.leaves[slot / kWide], slot % kWide, of.ends, places_.k[i]));
      continue;
    }
    const std::int32_t k = grid_.side < 0 ? -places_.k[i] : places_.k[i];
    const RowEdge edge{places_.x0[i], places_.y0[i], places_.x1[i], places_.y1[i], k};
    if (how == WidePlaces::kCrossing) {
      add(edge, places_.error[i]);
      continue;
    }
    count_error(places_.error[i]);
    keep(edge.y0 > edge.y1 ? RowEdge{edge.x1, edge.y1, edge.x0, edge.y0, -edge.k} : edge);
  }
  places_.count = 0;
}

}  // namespace penumbra::volumes
