// Form factors of parts of a light, many of them side by side. Lanes repeat the operations of UnshadowedLight::part in
// their order; parts that the horizon cuts are left to it.
#include "visibility/lights/part_form_factors.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/lights/part_form_factors.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "visibility/lights/form_factor-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::visibility::HWY_NAMESPACE {
namespace {

struct PartCorner {
  V s, t;
  V3 at;  // from p
};

double sum_of_parts_here(const UnshadowedLight& seen, const FourCorneredParts& parts) {
  const D d;
  const std::size_t lanes = hn::Lanes(d), count = parts.size();
  const UnshadowedLight::Frame frame = seen.frame();
  const V3 center = vector(frame.center), u = vector(frame.u), v = vector(frame.v), n = vector(seen.normal());
  const V height = number(frame.height), height_u = number(frame.height_u), height_v = number(frame.height_v);
  const V zero = hn::Zero(d), sign = number(-frame.side);
  std::array<double, kWidest> values{};
  double sum = 0;
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t here = std::min(lanes, count - first);
    M above = hn::FirstN(d, lanes), below = above;
    const auto corner = [&](std::size_t i) {
      const V s = hn::LoadU(d, parts.s(i) + first), t = hn::LoadU(d, parts.t(i) + first);
      const V high = hn::Add(hn::Add(height, hn::Mul(s, height_u)), hn::Mul(t, height_v));
      above = hn::And(above, hn::Ge(high, zero));
      below = hn::And(below, hn::Lt(high, zero));
      return PartCorner{s, t, (center + times(s, u)) + times(t, v)};
    };
    PartCorner from = corner(3);
    V part = zero;
    for (std::size_t i = 0; i < 4; ++i) {
      const PartCorner to = corner(i);
      part = hn::Add(part, terms(from.at, to.at, times(hn::Sub(to.s, from.s), u) + times(hn::Sub(to.t, from.t), v), n));
      from = to;
    }
    hn::StoreU(hn::IfThenElseZero(above, hn::Mul(sign, part)), d, values.data());
    std::array<std::uint8_t, kWidest / 8> known{};
    const M all_known = hn::Or(above, below);
    const bool each = hn::AllTrue(d, all_known);
    if (!each) hn::StoreMaskBits(d, all_known, known.data());
    for (std::size_t lane = 0; lane < here; ++lane) {
      if (each || (known[lane / 8] >> (lane % 8) & 1) != 0) {
        sum += values[lane];
        continue;
      }
      sum += seen.part(parts.get(first + lane));
    }
  }
  return sum;
}

}  // namespace
}  // namespace penumbra::visibility::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::visibility {

HWY_EXPORT(sum_of_parts_here);

double sum_of_parts(const UnshadowedLight& seen, const FourCorneredParts& parts) {
  return seen.shines() ? HWY_DYNAMIC_DISPATCH(sum_of_parts_here)(seen, parts) : 0;
}

}  // namespace penumbra::visibility
#endif
