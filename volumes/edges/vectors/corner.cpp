// SPDX-License-Identifier: Apache-2.0
// Edge scatter on a processor: the depth at the light's corner, to which edges add their changes. Bounds:
// docs/edge-scatter.md.

#include "visibility/certain_meeting.hpp"
#include "volumes/edges/vectors/corner.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volumes/edges/vectors/corner.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "engines/vectors/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::volumes::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vectors::HWY_NAMESPACE;

std::optional<bool> certainly_meets(const CornerInput& in, const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 p(in.at.p);
  if (!in.grid.cones) return visibility::certainly_meets(p, in.grid.corner, corners, in.grid.corner_off);
  const glm::dvec3 direction = in.grid.cones->of[in.at.cone].corner();
  if (!in.grid.cones->end) return visibility::ray_certainly_meets(p, direction, corners);
  return visibility::certainly_meets(p, p + direction, corners, 0x1p-51 * static_cast<double>(in.grid.reach));
}

/// Returns how many triangles the segment meets among those that float arithmetic leaves open.
std::uint32_t count_precisely(const CornerInput& in, std::size_t i, M which, Open& open) {
  std::uint32_t met = 0;
  for_each_lane(which, [&](std::size_t lane) {
    if (std::bit_cast<std::uint32_t>(in.triangles[kTrianglePlane][i + lane]) == in.light_plane) return;
    const auto slot = std::bit_cast<std::uint32_t>(in.triangles[kTriangleSlot][i + lane]);
    const WideTriangles& leaf = in.tree.leaves[slot / kWide];
    std::array<glm::vec3, 3> corners;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const WidePoints& x = leaf.corner[corner];
      corners[corner] = {x[0][slot % kWide], x[1][slot % kWide], x[2][slot % kWide]};
    }
    const std::optional<bool> meets = certainly_meets(in, corners);
    if (!meets) open.corner = true;
    met += meets.value_or(false) ? 1 : 0;
  });
  return met;
}

/// Returns the number of triangles that the segment from p to the light's lower left corner meets (Woop et al. 2013: in
/// coordinates with the ray as third axis, three two-dimensional products decide). With `one_will_do`, for view samples
/// whose edges do not change the count, stops at one. (bound corner)
std::uint32_t count_to_corner_here(const CornerInput& in, Open& open) {
  const D d;
  const TriangleTable& table = in.triangles;
  const ClusterSample& at = in.at;
  const glm::vec2 lean = at.lean;
  std::uint32_t met = 0;
  for (std::size_t i = 0; i < table.count && !(in.one_will_do && met > 0); i += hn::Lanes(d)) {
    const auto column = [&](std::size_t field) { return hn::Load(d, table[field] + i); };
    struct Corner {
      V x, y, w;
    };
    const auto corner = [&](std::size_t first) {
      const V w = hn::Sub(set(at.in_grid.z), column(first + 2));
      return Corner{hn::Sub(hn::Sub(column(first), set(at.in_grid.x)), hn::Mul(set(lean.x), w)),
                    hn::Sub(hn::Sub(column(first + 1), set(at.in_grid.y)), hn::Mul(set(lean.y), w)), w};
    };
    const Corner a = corner(kCornerA), b = corner(kCornerB), c = corner(kCornerC);
    const auto cross = [&](const Corner& p, const Corner& q) { return hn::Sub(hn::Mul(p.x, q.y), hn::Mul(p.y, q.x)); };
    const V fab = cross(a, b), fbc = cross(b, c), fca = cross(c, a);
    const V far = hn::Add(column(kTriangleFar), set(at.far));
    const V error_x = hn::Mul(set(at.per_lean), far);
    const auto size1 = [&](const Corner& p) { return hn::Add(hn::Abs(p.x), hn::Abs(p.y)); };
    const V size = hn::Max(size1(a), hn::Max(size1(b), size1(c)));
    const V twice = hn::Add(error_x, error_x);
    const V error = hn::MulAdd(hn::MulAdd(set(4 * kRound), size, twice), size, hn::Mul(twice, error_x));
    const V most = hn::Max(fab, hn::Max(fbc, fca)), least = hn::Min(fab, hn::Min(fbc, fca)), below = hn::Neg(error);
    const M sided = hn::Or(hn::Gt(least, error), hn::Lt(most, below));
    const M passes = hn::And(hn::Gt(most, error), hn::Lt(least, below));
    const M near =
        hn::AndNot(hn::Or(passes, same_bits(column(kTrianglePlane), bits(at.plane))), first_lanes(table.count - i));
    if (hn::AllFalse(d, near)) continue;
    const V w_most = hn::Max(a.w, hn::Max(b.w, c.w)), w_least = hn::Min(a.w, hn::Min(b.w, c.w));
    // Height over p of the point where the segment's line meets the triangle's plane: the mean of the corners' heights,
    // with weights f.
    const V total = hn::Add(fab, hn::Add(fbc, fca));
    const V meeting = hn::Div(hn::Add(hn::Mul(fbc, a.w), hn::Add(hn::Mul(fca, b.w), hn::Mul(fab, c.w))), total);
    const V near_p = hn::Mul(set(16 * kRound), far),
            near_light = hn::Mul(set(16 * kRound), hn::Add(far, set(in.grid.reach)));
    const V error_w =
        hn::Add(near_light, hn::Div(hn::Mul(set(6), hn::Mul(error, far)), hn::Max(hn::Abs(total), set(1e-30F))));
    const V height = set(at.end);
    const M within = hn::Or(hn::And(hn::Gt(meeting, error_w), hn::Lt(meeting, hn::Sub(height, error_w))),
                            hn::And(hn::Gt(w_least, near_p), hn::Lt(w_most, hn::Sub(height, near_light))));
    const M outside =
        hn::Or(hn::Or(hn::Lt(w_most, hn::Neg(near_p)), hn::Gt(w_least, hn::Add(height, near_light))),
               hn::And(sided, hn::Or(hn::Lt(meeting, hn::Neg(error_w)), hn::Gt(meeting, hn::Add(height, error_w)))));
    const M asked = hn::AndNot(outside, near);
    const M hit = hn::And(asked, hn::And(sided, within));
    met += static_cast<std::uint32_t>(hn::CountTrue(d, hit));
    const M left = hn::AndNot(hit, asked);
    if (!hn::AllFalse(d, left)) met += count_precisely(in, i, left, open);
  }
  return met;
}

}  // namespace
}  // namespace penumbra::volumes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::volumes {

HWY_EXPORT(count_to_corner_here);

std::uint32_t count_to_corner(const CornerInput& input, Open& open) {
  return HWY_DYNAMIC_DISPATCH(count_to_corner_here)(input, open);
}

}  // namespace penumbra::volumes
#endif
