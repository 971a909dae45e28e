// SPDX-License-Identifier: Apache-2.0
// Form factors of a whole light at many elements, a vector of elements at a time. Lanes repeat the operations of
// unshadowed_light.cpp and form_factor.cpp in their order, without contraction, so that all have the bits of the scalar
// code. Elements whose horizon cuts the light, elements so close to the light's plane that double does not decide their
// side, and ellipses are left to the scalar code.
#include "visibility/lights/whole_form_factors.hpp"

#include "base/assert.hpp"
#include "visibility/lights/angle_over_sine.hpp"
#include "visibility/lights/unshadowed_light.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <vector>

#ifndef PENUMBRA_WHOLE_FORM_FACTORS
#define PENUMBRA_WHOLE_FORM_FACTORS
namespace penumbra::visibility {
namespace {

/// A corner as p sees it: (centre + u) + v.
struct OutlineCorner {
  glm::dvec3 u, v;
  glm::dvec3 edge;  ///< from the previous corner
};

/// Data shared by all elements.
struct WholeLight {
  LightFrame frame;                    // unused for a sphere
  std::vector<OutlineCorner> corners;  // empty: round
  glm::dvec3 front{0};                 // unit, toward the emitting side
  glm::dvec3 across{0}, at_most{0};    // u × v, and the sum of the magnitudes of its products
};

WholeLight make_whole_light(const Light& light) {
  WholeLight whole;
  if (is_body(light.kind)) return whole;
  whole.frame = light_frame(light);
  const auto& [c, u, v] = whole.frame;
  whole.across = glm::cross(u, v);
  const glm::dvec3 a = glm::abs(u), b = glm::abs(v);
  whole.at_most = {a.y * b.z + b.y * a.z, a.z * b.x + b.z * a.x, a.x * b.y + b.x * a.y};
  whole.front = glm::normalize(whole.across);
  if (is_parallelogram(light.kind)) {
    whole.corners = {{-u, -v, -2.0 * v}, {u, -v, 2.0 * u}, {u, v, 2.0 * v}, {-u, v, -2.0 * u}};
  } else if (is_polygon(light.kind)) {
    const auto in_plane = [&](const glm::dvec3& direction) {
      return direction - glm::dot(whole.front, direction) * whole.front;
    };
    const std::size_t count = light.outline.size();
    for (std::size_t i = 0; i < count; ++i) {
      // in the order of form_factor.cpp's sum
      const glm::dvec3 from(light.outline[i]), to(light.outline[(i + 1) % count]);
      whole.corners.push_back({in_plane(to - c), glm::dvec3(0), in_plane(to - from)});
    }
  }
  return whole;
}

}  // namespace
}  // namespace penumbra::visibility
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/lights/whole_form_factors.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "visibility/lights/form_factor-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::visibility::HWY_NAMESPACE {
namespace {

V3 operator-(const V3& a, const V3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
V3 over(const V3& a, V s) {
  return {hn::Div(a.x, s), hn::Div(a.y, s), hn::Div(a.z, s)};
}
V3 normalize(const V3& a) {
  return times(hn::Div(number(1), hn::Sqrt(dot(a, a))), a);
}

/// A vector of elements, coordinate by coordinate.
struct ElementLanes {
  std::array<std::array<double, kWidest>, 3> p, n;
};

/// F, valid where `known`.
struct Wholes {
  V value;
  M known;
};

/// Side of the light's plane that p is on; `center` is the vector from p to the light's centre.
struct Sides {
  M front, known;
};
Sides sides_of(const WholeLight& light, const V3& center) {
  const V determinant = hn::Neg(dot(vector(light.across), center));
  const V3 size{hn::Abs(center.x), hn::Abs(center.y), hn::Abs(center.z)};
  // Seven roundings (J. Shewchuk, "Adaptive precision floating-point arithmetic", 1997, ORIENT3D): 8 ε of the products'
  // sizes.
  const V error = hn::Mul(number(0x1p-50), dot(vector(light.at_most), size));
  return {hn::Gt(determinant, hn::Zero(D())), hn::Gt(hn::Abs(determinant), error)};
}

/// Elements on dark sides, and those with the light below the horizon, get 0.
Wholes of_polygon(const Light& light, const WholeLight& whole, const V3& p, const V3& n) {
  const V zero = hn::Zero(D());
  const V3 center = vector(whole.frame.center) - p;
  const Sides sides = sides_of(whole, center);
  const bool is_rectangle = is_parallelogram(light.kind);
  const V height = dot(n, center), height_u = dot(n, vector(whole.frame.u)), height_v = dot(n, vector(whole.frame.v));
  // Heights of the corners: a rectangle's as in UnshadowedLight::part; a polygon's as in whole().
  const auto corner_of = [&](std::size_t i) {
    return (center + vector(whole.corners[i].u)) + vector(whole.corners[i].v);
  };
  const auto height_of = [&](std::size_t i, const V3& corner) {
    if (!is_rectangle) return dot(n, corner);
    const V first = i == 1 || i == 2 ? hn::Add(height, height_u) : hn::Sub(height, height_u);
    return i >= 2 ? hn::Add(first, height_v) : hn::Sub(first, height_v);
  };
  const std::size_t count = whole.corners.size();
  V3 before = corner_of(count - 1);
  M above = hn::Ge(height_of(count - 1, before), zero), below = hn::Lt(height_of(count - 1, before), zero);
  V sum = zero;
  for (std::size_t i = 0; i < count; ++i) {
    const V3 corner = corner_of(i);
    const V at = height_of(i, corner);
    above = hn::And(above, hn::Ge(at, zero));
    below = hn::And(below, hn::Lt(at, zero));
    sum = hn::Add(sum, terms(before, corner, vector(whole.corners[i].edge), n));
    before = corner;
  }
  // A rectangle runs counter-clockwise as seen from its front; an outline may have either orientation.
  const V signed_sum = hn::IfThenElse(sides.front, hn::Neg(sum), sum);
  const V value = is_rectangle ? hn::IfThenElse(hn::Gt(signed_sum, zero), signed_sum, zero) : hn::Abs(sum);
  const M lit = light.two_sided ? above : hn::And(above, sides.front);
  const M dark = light.two_sided ? below : hn::Or(below, hn::Not(sides.front));
  return {hn::IfThenElseZero(lit, value), hn::And(sides.known, hn::Or(lit, dark))};
}

/// Vector form of form_factor for a disk above or below the horizon.
Wholes of_disk(const V3& center, const V3& normal, V radius, const V3& n) {
  const V zero = hn::Zero(D());
  const V toward = hn::Neg(dot(normal, center));
  const M turned = hn::Lt(toward, zero);
  const auto turn = [&](V x) { return hn::IfThenElse(turned, hn::Neg(x), x); };
  const V3 z{turn(normal.x), turn(normal.y), turn(normal.z)};
  const V h = hn::Abs(toward);
  V3 off = V3{hn::Neg(center.x), hn::Neg(center.y), hn::Neg(center.z)} - times(h, z);
  off = off - times(dot(off, z), z);
  const V rho = hn::Sqrt(dot(off, off));
  const M beside =
      hn::Gt(rho, hn::Mul(number(0x1p-50), hn::Sqrt(dot(center, center))));  // on the axis, x may have any direction
  const V3 x = over(off, rho), y = cross(z, x);
  const V nx = dot(n, x), ny = dot(n, y), nz = dot(n, z);
  // Equations of class Rim (form_factor.cpp).
  const V b = hn::Mul(hn::Mul(number(2), rho), radius);
  const V rr = hn::Mul(radius, radius), oo = hn::Mul(rho, rho), hh = hn::Mul(h, h);
  const V a = hn::Add(hn::Add(rr, oo), hh);
  const auto square = [](V length) { return hn::Mul(length, length); };
  const V s = hn::Sqrt(hn::Mul(hn::Add(square(hn::Sub(radius, rho)), hh), hn::Add(square(hn::Add(radius, rho)), hh)));
  const V k = hn::Sqrt(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny))), middle = dot(n, center);
  const V reach = hn::Mul(radius, k);
  const M below = hn::Le(middle, hn::Neg(reach)), above = hn::AndNot(below, hn::Ge(middle, reach));
  const V q = hn::Sub(hn::Add(rr, hh), oo);
  const V far = hn::Div(hn::Mul(hn::Mul(hn::Mul(hn::Mul(number(4), rho), rho), h), h), hn::Sub(s, q));
  const V upper = hn::IfThenElse(hn::Ge(q, zero), hn::Add(q, s), far);
  const V sum =
      hn::Add(hn::Mul(hn::Mul(hn::Mul(nx, h), radius), b), hn::Mul(hn::Mul(hn::Mul(nz, radius), radius), upper));
  const V value = hn::Div(hn::Neg(sum), hn::Mul(s, hn::Add(a, s)));
  return {hn::IfThenElseZero(hn::And(above, hn::Gt(value, zero)), value), hn::And(beside, hn::Or(above, below))};
}

Wholes of_flat_disk(const Light& light, const WholeLight& whole, const V3& p, const V3& n) {
  const V3 center = vector(whole.frame.center) - p;
  const Sides sides = sides_of(whole, center);
  const auto away = [&](double x) { return hn::IfThenElse(sides.front, number(-x), number(x)); };
  const V3 along{away(whole.front.x), away(whole.front.y), away(whole.front.z)};
  const Wholes disk = of_disk(center, along, number(light.radius), n);
  if (light.two_sided) return {disk.value, hn::And(disk.known, sides.known)};
  return {hn::IfThenElseZero(sides.front, disk.value), hn::And(sides.known, hn::Or(disk.known, hn::Not(sides.front)))};
}

Wholes of_sun(const Light& light, const WholeLight& whole, const V3& n) {
  const glm::dvec3 along = glm::normalize(whole.frame.center);
  if (light.sun->tangent != 0) return of_disk(vector(whole.frame.center), vector(along), number(light.sun->tangent), n);
  const V cosine = dot(n, vector(along));
  return {hn::IfThenElseZero(hn::Gt(cosine, hn::Zero(D())), cosine), hn::Eq(cosine, cosine)};
}

/// Vector form of light_frame_from, and of the form factor of its disk.
Wholes of_sphere(const Light& light, const V3& p, const V3& n) {
  const V one = number(1), r = number(light.radius);
  const V3 c = vector(glm::dvec3(light.center)), q = p - c;
  const V d = hn::Sqrt(dot(q, q));
  const V touching = hn::Mul(hn::Sub(d, r), hn::Add(d, r));
  const V3 to = over(q, d);
  const V sign = hn::CopySign(one, to.z), slope = hn::Div(number(-1), hn::Add(sign, to.z));
  const V b = hn::Mul(hn::Mul(to.x, to.y), slope);
  const V3 axis{hn::Add(one, hn::Mul(hn::Mul(hn::Mul(sign, to.x), to.x), slope)), hn::Mul(sign, b),
                hn::Neg(hn::Mul(sign, to.x))};
  const V share = hn::Div(r, d), k = hn::Mul(share, share), radius = hn::Div(hn::Mul(r, hn::Sqrt(touching)), d);
  const V3 u = times(radius, axis);
  const Wholes disk = of_disk((c + times(k, q)) - p, normalize(c - p), hn::Sqrt(dot(u, u)), n);
  // d has an error below 4 ε of itself: p is outside if it is farther than that from the sphere.
  return {disk.value, hn::And(disk.known, hn::Gt(d, hn::Mul(r, number(1 + 0x1p-48))))};
}

void whole_form_factors_here(const Light& light, const SurfaceElements& elements, std::span<double> out) {
  const WholeLight whole = make_whole_light(light);
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  ElementLanes at;
  std::array<double, kWidest> values{};
  for (std::size_t first = 0; first < out.size(); first += lanes) {
    const std::size_t count = std::min(lanes, out.size() - first);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::uint32_t i = elements.which[first + std::min(lane, count - 1)];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        at.p[axis][lane] = double{elements.p[i][static_cast<int>(axis)]};
        at.n[axis][lane] = double{elements.n[i][static_cast<int>(axis)]};
      }
    }
    const auto load = [&](const auto& of) {
      return V3{hn::LoadU(d, of[0].data()), hn::LoadU(d, of[1].data()), hn::LoadU(d, of[2].data())};
    };
    const V3 p = load(at.p), n = normalize(load(at.n));
    const Wholes found = !whole.corners.empty()  ? of_polygon(light, whole, p, n)
                         : is_planar(light.kind) ? of_flat_disk(light, whole, p, n)
                         : is_body(light.kind)   ? of_sphere(light, p, n)
                                                 : of_sun(light, whole, n);
    hn::StoreU(found.value, d, values.data());
    std::copy_n(values.begin(), count, out.begin() + static_cast<std::ptrdiff_t>(first));
    if (hn::AllTrue(d, found.known)) continue;
    std::array<std::uint8_t, kWidest / 8> known{};
    hn::StoreMaskBits(d, found.known, known.data());
    for (std::size_t lane = 0; lane < count; ++lane) {
      if ((known[lane / 8] >> (lane % 8) & 1) != 0) continue;
      const std::uint32_t i = elements.which[first + lane];
      out[first + lane] = UnshadowedLight(light, elements.p[i], elements.n[i]).whole();
    }
  }
}

}  // namespace
}  // namespace penumbra::visibility::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::visibility {

HWY_EXPORT(whole_form_factors_here);

void whole_form_factors(const Light& light, const SurfaceElements& elements, std::span<double> whole) {
  PENUMBRA_ASSERT(elements.which.size() == whole.size(), "{} elements, {} form factors", elements.which.size(),
                  whole.size());
  if (!is_dome(light.kind) && (!is_round(light.kind) || is_circle(light.kind))) {
    return HWY_DYNAMIC_DISPATCH(whole_form_factors_here)(light, elements, whole);
  }
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const std::uint32_t at = elements.which[i];
    whole[i] = UnshadowedLight(light, elements.p[at], elements.n[at]).whole();
  }
}

}  // namespace penumbra::visibility
#endif
