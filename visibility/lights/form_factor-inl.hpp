// SPDX-License-Identifier: Apache-2.0
// Lambert's sum on vectors of doubles: the operations of form_factor.cpp in their order, without contraction, so that
// each lane has the bits of the scalar code. Included once for each target. Inside visibility/lights/ only.

#if defined(PENUMBRA_FORM_FACTOR_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_FORM_FACTOR_INL_HPP
#undef PENUMBRA_FORM_FACTOR_INL_HPP
#else
#define PENUMBRA_FORM_FACTOR_INL_HPP
#endif

#include "visibility/lights/angle_over_sine.hpp"

#include <hwy/highway.h>

#include <glm/vec3.hpp>

#include <cstddef>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace penumbra::visibility::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kWidest = 64;  // lanes: more than any vector has
using D = hn::CappedTag<double, kWidest>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

V number(double x) {
  return hn::Set(D(), x);
}

struct V3 {
  V x, y, z;
};
V3 vector(const glm::dvec3& a) {
  return {number(a.x), number(a.y), number(a.z)};
}
V3 operator+(const V3& a, const V3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
V3 times(V s, const V3& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
V dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
V3 cross(const V3& a, const V3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}
V series_of_arc(V q) {
  const V qq = hn::Mul(q, q);
  V even = number(kArcSeries[10]), odd = number(kArcSeries[11]);
  for (std::size_t i = 10; i > 0; i -= 2) {
    even = hn::Add(hn::Mul(even, qq), number(kArcSeries[i - 2]));
    odd = hn::Add(hn::Mul(odd, qq), number(kArcSeries[i - 1]));
  }
  return hn::Add(hn::Mul(odd, q), even);
}

/// Vector form of angle_over_sine; each lane takes its own branch.
V angles_over_sines(V squared, V along) {
  const V zero = hn::Zero(D()), square = hn::Mul(along, along);
  const M small = hn::Le(squared, hn::Mul(number(kArcSeriesEnd), square)), ahead = hn::Gt(along, zero),
          is_short = hn::And(small, ahead);
  if (hn::AllTrue(D(), is_short)) return hn::Div(series_of_arc(hn::Div(squared, square)), along);
  const V length = hn::Sqrt(squared), size = hn::Abs(along);
  const M is_far = hn::Gt(length, hn::Mul(number(kArcSeriesFar), size));
  const auto choose = [&](V far, V near, V middle) {
    return hn::IfThenElse(is_far, far, hn::IfThenElse(small, near, middle));
  };
  const V over_of = choose(hn::Neg(size), length, hn::Sub(length, size)),
          under = choose(length, size, hn::Add(length, size));
  const V ratio = hn::Div(hn::IfThenElse(is_short, squared, over_of), hn::IfThenElse(is_short, square, under));
  const V series = series_of_arc(hn::IfThenElse(is_short, ratio, hn::Mul(ratio, ratio)));
  const V base = choose(number(std::numbers::pi / 2), zero, number(std::numbers::pi / 4));
  const V acute = hn::Add(base, hn::Mul(ratio, series));
  const V angle = hn::IfThenElse(hn::Lt(along, zero), hn::Sub(number(std::numbers::pi), acute), acute);
  return hn::Div(hn::IfThenElse(is_short, series, angle), hn::IfThenElse(is_short, along, length));
}

/// Vector form of form_factor_term.
V terms(const V3& a, const V3& b, const V3& direction, const V3& n) {
  const V3 product = times(number(0.5), cross(a + b, direction));
  const V squared = dot(product, product);
  const V term = hn::Mul(hn::Mul(dot(n, product), angles_over_sines(squared, dot(a, b))), number(kPerTurn));
  return hn::IfThenZeroElse(hn::Eq(squared, hn::Zero(D())), term);
}

}  // namespace
}  // namespace penumbra::visibility::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for each target
