// SPDX-License-Identifier: Apache-2.0
// Edge scatter on a processor, rows=exact: visible fraction of the light from projected edges, without light samples.

#include "volumes/scatter/vectors/integrate.hpp"

#include "areas/form_factor_sum.hpp"
#include "visibility/lights/part_form_factors.hpp"
#include "visibility/lights/unshadowed_light.hpp"
#include "visibility/skies/sky.hpp"
#include "visibility/skies/sky_part.hpp"
#include "volumes/edges/vectors/corner.hpp"
#include "volumes/scatter/vectors/rows.hpp"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/scatter/vectors/integrate.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "engines/vectors/vectors-inl.hpp"
#include "volumes/edges/vectors/projection-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

/// Returns the depth at the light's corner, from the depth at a place away from all edges, counted by exact predicates.
std::optional<std::int32_t> depth_by_other_place(const ClusterInput& in, const LightWindow& window, const RowSum& rows,
                                                 const GridSample& at, OpenJudge& judge) {
  constexpr int kTries = 64;
  for (int i = 0; i < kTries; ++i) {
    // Kronecker's sequence with the square roots of 2 and 3: its points are on no lattice.
    const glm::dvec2 share = glm::fract(glm::dvec2(0.4142135623, 0.7320508075) * (i + 1.0));
    const std::optional<std::int32_t> relative = rows.relative_depth(share * 2.0 * glm::dvec2(in.grid.half_cells));
    if (!relative) continue;
    const std::optional<std::uint32_t> depth = judge.depth_in_plane(at, window.frame_place(share));
    return depth ? std::optional(static_cast<std::int32_t>(*depth) - *relative) : std::nullopt;
  }
  return std::nullopt;
}

/// Returns the depth at the corner for a sphere or sun, from the depth at one of the view sample's light samples.
std::optional<std::int32_t> depth_by_light_sample(const IntegralInput& in, const RowSum& rows, const GridSample& at,
                                                  OpenJudge& judge) {
  constexpr std::size_t kTries = 64;
  const LightGrid& grid = in.cluster.grid;
  const glm::dvec2 half(grid.half_cells);
  const double off = 2 * std::max(half.x, half.y) * static_cast<double>(grid.cones->deviation) /
                     glm::length(grid.cones->of[at.cone].u);
  const std::vector<glm::dvec2>& places = in.light.coordinates;
  const std::size_t step = std::max<std::size_t>(1, places.size() / kTries);
  for (std::size_t i = step / 2; i < places.size(); i += step) {
    // Edges outside of the square are not stored.
    if (glm::any(glm::greaterThan(glm::abs(places[i]) * half, half - off))) continue;
    const std::optional<std::int32_t> relative = rows.relative_depth((places[i] + 1.0) * half, off);
    if (relative) return static_cast<std::int32_t>(judge.depth(at, static_cast<std::uint32_t>(i))) - *relative;
  }
  return std::nullopt;
}

/// `parts`: the visible parts, if requested and neither all nor nothing is visible.
struct Rows {
  RowSum sum;
  const LightWindow& window;
  std::vector<Trapezoid> parts;
  bool parts_asked = false;
};

/// Returns the visible fraction; nullopt if double cannot prove it.
std::optional<double> share_of(const IntegralInput& input, EdgeScratch& scratch, const ClusterSample& at, Rows& all,
                               OpenJudge& judge) {
  const ClusterInput& in = input.cluster;
  RowSum& rows = all.sum;
  all.parts.clear();
  Open& open = scratch.open;
  open.clear();
  std::int32_t depth = 0;
  if (scratch.lists.triangles.count > 0) {
    const bool edges = scratch.lists.settled.count + scratch.lists.unsettled.count > 0;
    depth = static_cast<std::int32_t>(count_to_corner(
        {in.grid, in.tree, scratch.lists.triangles, at, !edges && !at.straddles && !at.meets_end, in.light_plane},
        open));
  }
  CrossingTable& crossing = scratch.crossing;
  // The vectors only select edges; those that they cannot place are included.
  const auto special = [&](const SpecialEdges& edges) {
    for_each_lane(edges.which, [&](std::size_t lane) {
      crossing[kK][crossing.count] = kUnknown;
      crossing[kEdge][crossing.count++] = edges.table[kGroupEdge][edges.first + lane];
    });
  };
  Projection{in, at, scratch.lists, crossing}(special);
  rows.set_view_sample(at);
  if (at.meets_end) rows.cut_at_disk(at);
  rows.add(crossing, in);
  if (rows.is_open()) return std::nullopt;
  if (open.corner || rows.corner_is_open()) {
    if (at.meets_end) return std::nullopt;  // a light sample is farther off the disk than casters may be
    const std::optional<std::int32_t> found = in.grid.cones ? depth_by_light_sample(input, rows, at, judge)
                                                            : depth_by_other_place(in, all.window, rows, at, judge);
    if (!found) return std::nullopt;
    depth = *found;
  }
  if (at.straddles) {
    rows.add_horizon(judge.horizon(at));
  } else if (scratch.crossing.count == 0 && !at.meets_end) {
    if (rows.is_open()) return std::nullopt;
    return depth == 0 ? 1 : 0;
  }
  return rows.visible_share(depth, all.parts_asked ? &all.parts : nullptr);
}

/// Form factors of view samples that see a part of the light.
class PartlyLit {
 public:
  explicit PartlyLit(const IntegralInput& in)
      : in_(in),
        cells_(2.0 * glm::dvec2(in.cluster.grid.half_cells)),
        is_plain_(!in.texture && !visibility::is_round(in.light.kind)) {}

  /// Returns the form factor; nullopt if double cannot prove it for a sky whose edges pass in front of bright parts.
  std::optional<glm::dvec3> form_factor(const GridSample& at, const Rows& rows) {
    const std::vector<Trapezoid>& parts = rows.parts;
    const visibility::UnshadowedLight unshadowed(in_.light, in_.samples.p[at.pixel], in_.samples.n[at.pixel]);
    if (in_.light.dome && in_.light.dome->sky) {
      visibility::SkyPart sky(in_.light);
      for (const Trapezoid& part : parts) sky.add(corners_of(part), visibility::SkyPart::Level::t);
      const glm::dvec3 form_factor = sky.take_form_factor(unshadowed.normal());
      // Sides are off by less than this angle; the luminance of a whole face is 4 times the mean or less.
      const double off = rows.sum.side_error() * 2 / std::min(cells_.x, cells_.y);
      if (!(off * sky.exposure() <= 4 * kProven * in_.light.dome->sky->mean_luminance())) return std::nullopt;
      return glm::max(form_factor, glm::dvec3(0));
    }
    if (is_plain_) {
      corners_.resize(parts.size());
      for (std::size_t i = 0; i < parts.size(); ++i) corners_.set(i, corners_of(parts[i]));
      return glm::dvec3(std::max(visibility::sum_of_parts(unshadowed, corners_), 0.0));
    }
    areas::FormFactorSum sum(unshadowed, in_.texture);
    for (const Trapezoid& part : parts) sum.add_polygon(corners_of(part));
    return glm::max(sum.sum(), glm::dvec3(0));
  }

 private:
  /// Returns the corners in the frame's coordinates, counter-clockwise.
  [[nodiscard]] std::array<glm::dvec2, 4> corners_of(const Trapezoid& part) const {
    const auto& [low, high] = part;
    const auto corner = [&](double x, double y) { return in_.region.window.frame_place(glm::dvec2(x, y) / cells_); };
    return {corner(low.left, low.y), corner(low.right, low.y), corner(high.right, high.y), corner(high.left, high.y)};
  }

  const IntegralInput& in_;
  glm::dvec2 cells_;
  bool is_plain_;
  visibility::FourCorneredParts corners_;
};

std::size_t integrate_here(const IntegralInput& input, EdgeScratch& scratch, OpenJudge& judge, const Integral& out) {
  const ClusterInput& in = input.cluster;
  Rows rows{RowSum(in.grid, input.region, input.scene, input.scale), input.region.window, {}, !out.radiance.empty()};
  PartlyLit partly_lit(input);
  std::size_t unproven = 0;
  const auto use_exact = [&](std::size_t i) {
    ++unproven;
    const areas::ExactView exact = input.areas.view(input.samples, in.samples[i].pixel);
    out.shares[i] = static_cast<float>(exact.visibility);
    if (!out.radiance.empty()) out.radiance[i] = exact.form_factor;
  };
  for_each_sample(in, scratch.lists, [&](std::size_t i) {
    const ClusterSample& at = in.samples[i];
    const std::optional<double> share = share_of(input, scratch, at, rows, judge);
    if (!share) return use_exact(i);
    out.shares[i] = static_cast<float>(*share);
    const bool is_partial = out.shares[i] != 0 && out.shares[i] != 1;
    if (out.radiance.empty() || !is_partial) return;
    const std::optional<glm::dvec3> form_factor = partly_lit.form_factor(at, rows);
    if (form_factor)
      out.radiance[i] = *form_factor;
    else
      use_exact(i);
  });
  return unproven;
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(integrate_here);

std::size_t integrate(const IntegralInput& input, EdgeScratch& scratch, OpenJudge& judge, const Integral& out) {
  return HWY_DYNAMIC_DISPATCH(integrate_here)(input, scratch, judge, out);
}

}  // namespace penumbra::volumes
#endif
