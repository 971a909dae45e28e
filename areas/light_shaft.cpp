// SPDX-License-Identifier: Apache-2.0
// Classifies points against the clip planes of a light's shaft in double, with error bounds. BackProjection has the
// exact test.

#include "areas/light_shaft.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace penumbra::areas {
namespace {

// Each height is a sum of products of at most three differences of stored numbers and one grid coordinate. `size` is
// the sum of the magnitudes of these products, so that nothing cancels in it. With δ = 2⁻⁵³: differences are off by δ
// each, products and sums by another δ in each step, ten steps at most from the stored numbers to the height: less than
// 2⁻⁴⁸ = 32 δ times the size (which is itself rounded, by far less than the rest).
constexpr double kRounding = 0x1p-48;

struct Cross {
  glm::dvec3 value, size;
};
Cross cross_of(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 x = glm::abs(a), y = glm::abs(b);
  return {glm::cross(a, b), {x.y * y.z + x.z * y.y, x.z * y.x + x.x * y.z, x.x * y.y + x.y * y.x}};
}

}  // namespace

LightShaft::LightShaft(const IntegerFrame& frame, bool mirrored, const glm::vec3& p, const GridBox& box) : p_(p) {
  const glm::dvec3 u = frame.u_end - frame.origin, v = frame.v_end - frame.origin,
                   r = frame.endless ? -frame.c : p_ - frame.c;
  // The gradients of S, T and W (back_projection.hpp), and K.
  const Cross s = cross_of(v, r), t = cross_of(r, u), w = cross_of(v, u);
  const double reach = -glm::dot(w.value, r);
  const double sign = mirrored ? -1 : 1;
  const auto side = [&](const Cross& along, const mpz_class& limit, double direction) {
    const double at = limit.get_d() / static_cast<double>(GridBox::kGrid);
    return Plane{sign * direction * (along.value - at * w.value), along.size + glm::abs(at) * w.size, 0, 0};
  };
  Plane& end = planes_[static_cast<std::size_t>(ClipPlane::light)];
  end = {-sign * w.value, w.size, sign * reach, glm::dot(w.size, glm::abs(r))};
  if (frame.endless) end = {glm::dvec3(0), glm::dvec3(0), 1, 0};
  planes_[static_cast<std::size_t>(ClipPlane::left)] = side(s, box.s0, 1);
  planes_[static_cast<std::size_t>(ClipPlane::right)] = side(s, box.s1, -1);
  planes_[static_cast<std::size_t>(ClipPlane::bottom)] = side(t, box.t0, 1);
  planes_[static_cast<std::size_t>(ClipPlane::top)] = side(t, box.t1, -1);
  planes_[kClipPlanes] = {sign * w.value, w.size, 0, 0};
}

LightShaft::Sides LightShaft::sides_of(const glm::vec3& q) const {
  const glm::dvec3 d = glm::dvec3(q) - p_, size = glm::abs(d);
  Sides sides;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Plane& plane = planes_[i];
    const double height = plane.constant + glm::dot(plane.normal, d);
    const double error = kRounding * (plane.constant_size + glm::dot(plane.size, size));
    if (height > error) sides.inside |= 1u << i;
    if (height < -error) sides.outside |= 1u << i;
  }
  return sides;
}

bool LightShaft::misses(const glm::vec3& lower, const glm::vec3& upper) const {
  const glm::dvec3 center = 0.5 * (glm::dvec3(lower) + glm::dvec3(upper)) - p_;
  const glm::dvec3 half = 0.5 * (glm::dvec3(upper) - glm::dvec3(lower));
  const glm::dvec3 size = glm::abs(center) + half;
  for (const Plane& plane : planes_) {
    const double highest = plane.constant + glm::dot(plane.normal, center) + glm::dot(glm::abs(plane.normal), half);
    if (highest < -kRounding * (plane.constant_size + glm::dot(plane.size, size))) return true;
  }
  return false;
}

}  // namespace penumbra::areas
