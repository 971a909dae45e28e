// SPDX-License-Identifier: Apache-2.0
// Signed edges on a processor: a group's edges that vectors cannot handle, for light samples that are not in rows.
// Inside volumes/ only.

#if defined(PENUMBRA_VOLUMES_VECTORS_SPECIAL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_VOLUMES_VECTORS_SPECIAL_INL_HPP
#undef PENUMBRA_VOLUMES_VECTORS_SPECIAL_INL_HPP
#else
#define PENUMBRA_VOLUMES_VECTORS_SPECIAL_INL_HPP
#endif

#include "volumes/edges/vectors/edge_scratch.hpp"
#include "volumes/edges/vectors/precise.hpp"
#include "volumes/edges/vectors/projection-inl.hpp"

#include <algorithm>
#include <bit>
#include <optional>

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

/// Calls visit(edge, k) for each edge whose multiplicity is certain, by exact predicates if needed. An edge whose
/// multiplicity stays uncertain opens the view sample.
template <typename Visit>
[[maybe_unused]] void for_each_sure(const ClusterInput& in, const ClusterSample& at, const SpecialEdges& edges,
                                    OpenJudge& judge, Open& view_sample, Visit visit) {
  HWY_ALIGN float k[hn::MaxLanes(D())];
  std::uint8_t open[8] = {};
  hn::Store(edges.multiplicity.k, D(), k);
  hn::StoreMaskBits(D(), edges.multiplicity.open, open);
  for_each_lane(edges.which, [&](std::size_t lane) {
    const auto edge = std::bit_cast<std::uint32_t>(edges.table[kGroupEdge][edges.first + lane]);
    const bool is_open = (open[lane / 8] >> (lane % 8) & 1) != 0;
    const std::optional<float> sure = is_open ? exact_multiplicity(in.edges, edge, at, judge) : std::optional(k[lane]);
    if (!sure) view_sample.pixel = true;
    if (sure) visit(edge, *sure);
  });
}

/// Places edges individually and adds them to the table of crossings.
[[maybe_unused]] void place_special(const ClusterInput& in, EdgeScratch& s, const ClusterSample& at,
                                    const SpecialEdges& edges, OpenJudge& judge) {
  for_each_sure(in, at, edges, judge, s.open, [&](std::uint32_t edge, float k) {
    const auto placed = place_edge({in, at, edge, k, edges.settled, std::nullopt}, s.open);
    if (!placed) return;
    CrossingTable& out = s.crossing;
    out[kX0][out.count] = placed->a().x;
    out[kY0][out.count] = placed->a().y;
    out[kX1][out.count] = placed->b().x;
    out[kY1][out.count] = placed->b().y;
    out[kK][out.count] = k;
    out[kError][out.count] = std::max(placed->error_near, placed->error_far);
    out[kEdge][out.count] = std::bit_cast<float>(edges.settled ? edge : edge | kUnsettled);
    ++out.count;
  });
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
