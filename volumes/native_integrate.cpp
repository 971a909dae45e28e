// Edge scatter on a processor, rows=exact: from edges as they appear to the visible share of the light, without light
// samples.

#include "volumes/native_rows.hpp"
#include "volumes/native_scatter.hpp"

#include <glm/common.hpp>

#include <bit>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/native_integrate.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "native/vectors-inl.hpp"
#include "volumes/native_projection-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

constexpr std::size_t kGroup = 16;  // view samples that sort out edges together

/// The depth at the light's corner, from that at a place that no edge comes near: exact predicates count there.
std::optional<std::int32_t> depth_by_other_place(const Frame& frame, const RowSum& rows, const Placed& at,
                                                 Judge& judge) {
  constexpr int kTries = 64;
  for (int i = 0; i < kTries; ++i) {
    // Kronecker's sequence with the square roots of 2 and 3: on no lattice.
    const glm::dvec2 share = glm::fract(glm::dvec2(0.4142135623, 0.7320508075) * (i + 1.0));
    const std::optional<std::int32_t> relative = rows.relative_depth(share * 2.0 * glm::dvec2(frame.half_cells));
    if (relative) return static_cast<std::int32_t>(judge.depth(at, 2.0 * share - 1.0)) - *relative;
  }
  return std::nullopt;
}

/// Nothing: left to light samples.
std::optional<double> share_of(const ScatterInput& in, Scratch& scratch, const Sample& at, RowSum& rows, Judge& judge) {
  Open& open = scratch.open;
  open.clear();
  std::int32_t depth = 0;
  if (scratch.lists.triangles.count > 0) {
    const bool edges = scratch.lists.settled.count + scratch.lists.unsettled.count > 0;
    depth = static_cast<std::int32_t>(
        count_to_corner({in.frame, in.tree, scratch.lists.triangles, at, !edges && !at.straddles}, open));
  }
  CrossingTable& crossing = scratch.crossing;
  // The vectors only sort out; what they cannot place is looked at as well.
  const auto special = [&](const SpecialEdges& edges) {
    for_each_lane(edges.which, [&](std::size_t lane) {
      crossing[kEdge][crossing.count++] = edges.table[kGroupEdge][edges.first + lane];
    });
  };
  Projection{in, at, scratch.lists, crossing}(special);
  rows.clear();
  for (std::size_t i = 0; i < crossing.count; ++i) {
    const std::uint32_t edge = std::bit_cast<std::uint32_t>(crossing[kEdge][i]) & ~kUnsettled;
    const auto slot = std::bit_cast<std::uint32_t>(in.edges[kEdgeSlot][edge]);
    if (!rows.add(in.edge_tree.leaves[slot / kWide], slot % kWide, at)) return std::nullopt;
  }
  if (open.corner || rows.corner_is_open()) {
    const std::optional<std::int32_t> found = depth_by_other_place(in.frame, rows, at, judge);
    if (!found) return std::nullopt;
    depth = *found;
  }
  if (at.straddles) {
    rows.add_horizon(judge.horizon(at));
  } else if (scratch.crossing.count == 0) {
    return depth == 0 ? 1 : 0;
  }
  return rows.visible_share(depth);
}

void integrate_here(const ScatterInput& in, Scratch& scratch, Judge& judge, std::span<Seen> seen,
                    std::span<float> shares) {
  RowSum rows(in.frame);
  for (std::size_t first = 0; first < in.samples.size(); first += kGroup) {
    const auto group = in.samples.subspan(first, std::min(kGroup, in.samples.size() - first));
    sort_out(in, group, scratch.lists);
    for (std::size_t i = 0; i < group.size(); ++i) {
      const std::optional<double> share = share_of(in, scratch, group[i], rows, judge);
      if (share) {
        shares[first + i] = static_cast<float>(*share);
        continue;
      }
      scratch.open.clear();
      scratch.open.pixel = true;
      std::fill_n(seen[first + i].mask, mask_words(in.frame), std::uint16_t{0});
      judge.decide(group[i], scratch.open, seen[first + i]);
      shares[first + i] =
          static_cast<float>(seen[first + i].visible) / static_cast<float>(in.frame.rows * in.frame.columns);
    }
  }
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(integrate_here);

void integrate(const ScatterInput& input, Scratch& scratch, Judge& judge, std::span<Seen> seen,
               std::span<float> shares) {
  HWY_DYNAMIC_DISPATCH(integrate_here)(input, scratch, judge, seen, shares);
}

}  // namespace penumbra::volumes
#endif
