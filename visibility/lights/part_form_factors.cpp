// SPDX-License-Identifier: Apache-2.0
// Form factors of parts of a light, a vector of parts at a time. Lanes repeat the operations of UnshadowedLight::part
// in their order, including cuts at the horizon (FormFactorLoop).
#include "visibility/lights/part_form_factors.hpp"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/lights/part_form_factors.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "visibility/lights/form_factor-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::visibility::HWY_NAMESPACE {
namespace {

struct PartCorner {
  V s, t;
  V3 at;  // relative to p
  V height;
};

V3 operator-(const V3& a, const V3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
V3 choose(M mask, const V3& yes, const V3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}
V add_where(M mask, V sum, V term) {
  return hn::Add(sum, hn::IfThenElseZero(mask, term));
}

/// FormFactorLoop of a vector of parts; edges are added in order.
class Loops {
 public:
  explicit Loops(const V3& n) : n_(n) {}

  void add(const PartCorner& from, const PartCorner& to, const V3& direction) {
    const M above_from = hn::Ge(from.height, hn::Zero(D())), above_to = hn::Ge(to.height, hn::Zero(D()));
    const M any = hn::Or(above_from, above_to), cut = hn::AndNot(hn::And(above_from, above_to), any);
    if (hn::AllFalse(D(), cut)) {
      sum_ = add_where(any, sum_, terms(from.at, to.at, direction, n_));
      return;
    }
    const M leaves = hn::And(cut, above_from), enters = hn::And(cut, above_to);
    const V down = hn::Div(from.height, hn::Sub(from.height, to.height)),
            up = hn::Div(to.height, hn::Sub(to.height, from.height));
    const V3 kept = choose(cut, times(hn::IfThenElse(leaves, down, up), direction), direction);
    const V3 place = choose(leaves, from.at + kept, to.at - kept);
    sum_ = add_where(any, sum_, terms(choose(enters, place, from.at), choose(leaves, place, to.at), kept, n_));
    const M closes = hn::Or(hn::And(leaves, has_up_), hn::And(enters, has_down_));
    if (!hn::AllFalse(D(), closes)) {
      const V3 low = choose(leaves, place, down_), high = choose(leaves, up_, place);
      sum_ = add_where(closes, sum_, terms(low, high, high - low, n_));
    }
    down_ = choose(leaves, place, down_);
    up_ = choose(enters, place, up_);
    has_down_ = hn::AndNot(closes, hn::Or(has_down_, leaves));
    has_up_ = hn::AndNot(closes, hn::Or(has_up_, enters));
  }
  [[nodiscard]] V sum() const { return sum_; }

 private:
  V3 n_;
  V sum_ = hn::Zero(D());
  V3 down_{sum_, sum_, sum_}, up_{sum_, sum_, sum_};  // where the loop went below the horizon, and came back
  M has_down_ = hn::FirstN(D(), 0), has_up_ = has_down_;
};

double sum_of_parts_here(const UnshadowedLight& seen, const FourCorneredParts& parts) {
  const D d;
  const std::size_t lanes = hn::Lanes(d), count = parts.size();
  const UnshadowedLight::Frame frame = seen.frame();
  const V3 center = vector(frame.center), u = vector(frame.u), v = vector(frame.v), n = vector(seen.normal());
  const V height = number(frame.height), height_u = number(frame.height_u), height_v = number(frame.height_v);
  const V sign = number(-frame.side);
  std::array<double, kWidest> values{};
  double sum = 0;
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t here = std::min(lanes, count - first);
    const auto corner = [&](std::size_t i) {
      const V s = hn::LoadU(d, parts.s(i) + first), t = hn::LoadU(d, parts.t(i) + first);
      return PartCorner{s, t, (center + times(s, u)) + times(t, v),
                        hn::Add(hn::Add(height, hn::Mul(s, height_u)), hn::Mul(t, height_v))};
    };
    PartCorner from = corner(3);
    Loops loops(n);
    for (std::size_t i = 0; i < 4; ++i) {
      const PartCorner to = corner(i);
      loops.add(from, to, times(hn::Sub(to.s, from.s), u) + times(hn::Sub(to.t, from.t), v));
      from = to;
    }
    hn::StoreU(hn::Mul(sign, loops.sum()), d, values.data());
    for (std::size_t lane = 0; lane < here; ++lane) sum += values[lane];
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
