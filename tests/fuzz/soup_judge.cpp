// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/soup_judge.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::fuzz {
namespace {

using Point = std::array<mpz_class, 3>;

Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

int sign_of_determinant(const Point& a, const Point& b, const Point& c) {
  const mpz_class value =
      a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  return sgn(value);
}

/// Returns the side of the plane through a, b, c on which the point is: positive if they run counter-clockwise as seen
/// from it.
int side(const std::array<Point, 3>& abc, const Point& x) {
  return sign_of_determinant(minus(abc[1], abc[0]), minus(abc[2], abc[0]), minus(x, abc[0]));
}

bool has_area(const std::array<Point, 3>& abc) {
  const Point u = minus(abc[1], abc[0]), v = minus(abc[2], abc[0]);
  return sgn(mpz_class(u[1] * v[2] - u[2] * v[1])) != 0 || sgn(mpz_class(u[2] * v[0] - u[0] * v[2])) != 0 ||
         sgn(mpz_class(u[0] * v[1] - u[1] * v[0])) != 0;
}

/// Returns the exponent of a float's last binary digit; large for 0.
int last_digit(float x) {
  if (x == 0) return 1000;
  int exponent = 0;
  auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(static_cast<double>(x), &exponent), 53));
  exponent -= 53;
  for (; digits % 2 == 0; digits /= 2) ++exponent;
  return exponent;
}

}  // namespace

SoupJudge::SoupJudge(const SoupCase& judged) : case_(judged) {
  exponent_ = 1000;
  const auto look_at = [&](const glm::vec3& x) {
    for (int i = 0; i < 3; ++i) exponent_ = std::min(exponent_, last_digit(x[i]));
  };
  const visibility::Light& light = judged.light;
  for (const glm::vec3& x : judged.floats.positions) look_at(x);
  for (const glm::vec3& x : judged.samples.p) look_at(x);
  for (const glm::vec3& x : light.points) look_at(x);
  for (const glm::vec3& x : {light.center, light.center_u, light.center_v}) look_at(x);

  center_ = exactly(light.center);
  u_ = minus(exactly(light.center_u), center_);
  v_ = minus(exactly(light.center_v), center_);
  for (const glm::vec3& x : light.points) light_points_.push_back(exactly(x));
  for (std::uint32_t i = 0; i < judged.floats.triangles.size(); ++i) {
    const scenes::Object& object = judged.scene.objects[judged.floats.object[i]];
    const bool own_body = object.emits && static_cast<std::int32_t>(*object.emits) == light.index;
    Caster caster{corners_of(i), {}};
    if (!object.casts_shadow || own_body || !has_area(caster.corners)) continue;
    for (const Point& l : light_points_) caster.side_of_light_sample.push_back(side(caster.corners, l));
    casters_.push_back(std::move(caster));
  }
}

SoupJudge::Point SoupJudge::exactly(const glm::vec3& x) const {
  Point point;
  for (int i = 0; i < 3; ++i) {
    if (x[i] == 0) continue;
    const int shift = last_digit(x[i]);
    point[static_cast<std::size_t>(i)] = mpz_class(std::ldexp(static_cast<double>(x[i]), -shift))
                                         << static_cast<mp_bitcnt_t>(shift - exponent_);
  }
  return point;
}

std::array<SoupJudge::Point, 3> SoupJudge::corners_of(std::uint32_t triangle) const {
  const auto corners = case_.floats.corners(triangle);
  return {exactly(corners[0]), exactly(corners[1]), exactly(corners[2])};
}

int SoupJudge::edge_sign(const Point& p, const Point& l, const Point& a, const Point& b) const {
  const Point pa = minus(a, p), pb = minus(b, p);
  for (const Point& direction : {minus(l, p), u_, v_}) {
    if (const int sign = sign_of_determinant(direction, pa, pb); sign != 0) return sign;
  }
  return 0;
}

bool SoupJudge::sees(std::size_t pixel, std::uint32_t light_sample) const {
  const visibility::ViewSamples& samples = case_.samples;
  const Point p = exactly(samples.p[pixel]);
  const Point& l = light_points_[light_sample];
  const auto carrier = corners_of(static_cast<std::uint32_t>(samples.triangle[pixel]));
  // The pair's conditions: (1) l is strictly on the viewer's side, (2) p is strictly on an emitting side.
  if (side(carrier, l) * samples.facing[pixel] <= 0) return false;
  const int front = sign_of_determinant(u_, v_, minus(p, center_));
  if (case_.light.two_sided ? front == 0 : front <= 0) return false;
  // (3) No other triangle meets the open segment.
  for (const Caster& caster : casters_) {
    const std::array<Point, 3>& abc = caster.corners;
    const int side_of_p = side(abc, p), side_of_l = caster.side_of_light_sample[light_sample];
    if (side_of_p * side_of_l >= 0) continue;  // both on one side, or the plane contains p or l
    const bool coplanar = std::ranges::all_of(abc, [&](const Point& x) { return side(carrier, x) == 0; });
    if (coplanar) continue;
    const int first = edge_sign(p, l, abc[0], abc[1]);
    if (first != 0 && first == edge_sign(p, l, abc[1], abc[2]) && first == edge_sign(p, l, abc[2], abc[0]))
      return false;
  }
  return true;
}

}  // namespace penumbra::fuzz
