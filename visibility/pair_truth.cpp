// SPDX-License-Identifier: Apache-2.0
// The truth of a pair (docs/definitions.md), decided exactly.

#include "visibility/pair_truth.hpp"

#include "visibility/certain_meeting.hpp"
#include "visibility/dome_faces.hpp"

#include "base/assert.hpp"

#include <CGAL/MP_Float.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra::visibility {
namespace {

using Exact = CGAL::MP_Float;  // every sum, difference and product of doubles, without rounding

struct ExactVector {
  Exact x, y, z;
};
template <typename Vector>
ExactVector difference(const Vector& to, const Vector& from) {
  const auto one = [](double a, double b) { return Exact(a) - Exact(b); };
  return {one(to.x, from.x), one(to.y, from.y), one(to.z, from.z)};
}

int sign_of_determinant(const ExactVector& a, const ExactVector& b, const ExactVector& c) {
  const Exact value = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
  return static_cast<int>(CGAL::sign(value));
}

struct EdgeSign {
  int sign = 0;
  bool was_zero = false;
};

/// Returns the sign of (p, l; a b): the side of the line p→l on which the edge a→b passes. It is the sign of det(l − p,
/// a − p, b − p), which is affine in l. If that is zero, the sign at l + ε·u + ε²·v counts: that of det(u, a − p, b −
/// p), or, if this is zero too, of det(v, a − p, b − p). It is antisymmetric in a and b, so neighbouring triangles
/// agree about their edge. All three vanish only if p is on the line a b (then p is on the triangle's plane, and the
/// triangle is not met) or on the light's plane (then condition (2) has already refused the pair). For a sun l is a
/// direction and stands for l − p; its axes span a plane that contains no direction to it. For a dome the axes are
/// those of the face that contains l.
EdgeSign edge_sign(const glm::vec3& p, const glm::vec3& l, const glm::vec3& a, const glm::vec3& b, const Light& light) {
  const int sign = static_cast<int>(light.sun ? side_of_direction(p, a, b, l) : side_of_plane(p, l, a, b));
  if (sign != 0) return {sign, false};
  const ExactVector pa = difference(a, p), pb = difference(b, p);
  ExactVector u, v;
  if (is_body(light.kind)) {
    const LightFrame frame = light_frame_from(light, p);
    u = difference(frame.u, glm::dvec3(0));
    v = difference(frame.v, glm::dvec3(0));
  } else if (light.dome && light.dome->face < 0) {
    const DomeFace face = dome_face(*light.dome, dome_face_of(*light.dome, l));
    u = difference(face.u, glm::vec3(0));
    v = difference(face.v, glm::vec3(0));
  } else if (light.sun) {
    u = difference(light.sun->axis_u, glm::vec3(0));
    v = difference(light.sun->axis_v, glm::vec3(0));
  } else {
    u = difference(light.center_u, light.center);
    v = difference(light.center_v, light.center);
  }
  const int along_u = sign_of_determinant(u, pa, pb);
  return {along_u != 0 ? along_u : sign_of_determinant(v, pa, pb), true};
}

bool boxes_touch(const glm::vec3& p, const glm::vec3& l, const std::array<glm::vec3, 3>& corners, const Light& light) {
  const auto& [a, b, c] = corners;
  for (int i = 0; i < 3; ++i) {
    if (light.sun) {  // the box of a ray has no end
      if (l[i] >= 0 && glm::max(a[i], glm::max(b[i], c[i])) < p[i]) return false;
      if (l[i] <= 0 && glm::min(a[i], glm::min(b[i], c[i])) > p[i]) return false;
      continue;
    }
    if (glm::max(a[i], glm::max(b[i], c[i])) < glm::min(p[i], l[i])) return false;
    if (glm::min(a[i], glm::min(b[i], c[i])) > glm::max(p[i], l[i])) return false;
  }
  return true;
}

}  // namespace

int edge_side(const glm::vec3& p, const glm::vec3& l, const glm::vec3& a, const glm::vec3& b, const Light& light) {
  return edge_sign(p, l, a, b, light).sign;
}

Meeting segment_meets_triangle(const glm::vec3& p, const glm::vec3& l, const std::array<glm::vec3, 3>& corners,
                               const Light& light) {
  const std::optional<bool> certain = light.sun ? ray_certainly_meets(glm::dvec3(p), glm::dvec3(l), corners)
                                                : certainly_meets(glm::dvec3(p), glm::dvec3(l), corners);
  if (certain) return {*certain, false};
  const auto& [a, b, c] = corners;
  const Side side_p = side_of_plane(a, b, c, p);
  const Side side_l = light.sun ? side_of_direction(a, b, c, l) : side_of_plane(a, b, c, l);
  const bool plane_zero = side_p == Side::on || side_l == Side::on;
  if (!plane_zero && side_p == side_l) return {};

  // The line p→l crosses the plane, or touches it at p or l. It passes through the triangle iff all three edges pass it
  // on the same side.
  bool some_left = false, some_right = false, edge_zero = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const EdgeSign edge = edge_sign(p, l, corners[i], corners[(i + 1) % 3], light);
    edge_zero |= edge.was_zero;
    if (edge.was_zero) continue;
    some_left |= edge.sign > 0;
    some_right |= edge.sign < 0;
  }
  if (some_left && some_right) return {};  // it misses the triangle, however zeros are resolved
  if (plane_zero) return {false, !collinear(a, b, c)};
  if (!edge_zero) return {true, false};
  bool all_left = true, all_right = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const int sign = edge_sign(p, l, corners[i], corners[(i + 1) % 3], light).sign;
    all_left &= sign > 0;
    all_right &= sign < 0;
  }
  return {all_left || all_right, true};
}

PlanePoint::PlanePoint(const Light& light, const glm::dvec2& at) : st(at) {
  const auto [c, u, v] = light_frame(light);
  rounded = c + st.x * u + st.y * v;
  // Two differences, two products and two sums are rounded, each at most as large as these lengths.
  off = 0x1p-50 * (glm::length(c) + std::abs(st.x) * glm::length(u) + std::abs(st.y) * glm::length(v));
}

bool meets_before_light(const glm::vec3& p, const PlanePoint& l, const std::array<glm::vec3, 3>& corners,
                        const Light& light) {
  if (const std::optional<bool> certain = certainly_meets(glm::dvec3(p), l.rounded, corners, l.off)) return *certain;
  const auto& [a, b, c] = corners;
  // Tests whether a part of the triangle is between p and the light's plane: cheaper than the tests below, and decides
  // triangles in the light's plane.
  const auto side = [&](const glm::vec3& x) { return side_of_plane(light.center, light.center_u, light.center_v, x); };
  const Side before = side(p);
  if (std::ranges::none_of(corners, [&](const glm::vec3& corner) { return side(corner) == before; })) return false;
  const Side side_p = side_of_plane(a, b, c, p);
  if (side_p == Side::on) return false;
  const ExactVector u = difference(light.center_u, light.center), v = difference(light.center_v, light.center);
  const Exact s(l.st.x), t(l.st.y);
  const auto segment_from = [&](const glm::vec3& x) {
    const ExactVector d = difference(light.center, x);
    return ExactVector{d.x + s * u.x + t * v.x, d.y + s * u.y + t * v.y, d.z + s * u.z + t * v.z};
  };
  const int side_l = sign_of_determinant(difference(b, a), difference(c, a), segment_from(a));
  if (side_l * static_cast<int>(side_p) >= 0) return false;
  const ExactVector toward = segment_from(p);
  const std::array d{difference(a, p), difference(b, p), difference(c, p)};
  int first = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    int sign = 0;
    for (const ExactVector* direction : {&toward, &u, &v}) {
      if (sign == 0) sign = sign_of_determinant(*direction, d[i], d[(i + 1) % 3]);
    }
    if (sign == 0 || sign == -first) return false;
    first = sign;
  }
  return true;
}

bool above_horizon(const std::array<glm::vec3, 3>& carrier, std::int8_t facing, const glm::vec3& l) {
  return static_cast<int>(side_of_plane(carrier[0], carrier[1], carrier[2], l)) * facing > 0;
}

namespace {

int sign_above(const Light& light, const std::array<glm::vec3, 3>& carrier, const glm::vec3& l) {
  const auto& [a, b, c] = carrier;
  return static_cast<int>(light.sun ? side_of_direction(a, b, c, l) : side_of_plane(a, b, c, l));
}

/// Returns whether |p − c| > r, for the stored centre and the radius in double.
bool outside_sphere(const Light& light, const glm::vec3& p) {
  const glm::dvec3 d = glm::dvec3(p) - glm::dvec3(light.center);
  const double far = glm::dot(d, d), near = light.radius * light.radius;
  // Differences, squares and two sums have fewer than 8 roundings, relative to `far` or `near`; results that underflow
  // are not certain.
  const double error = 0x1p-49 * (far + near);
  if (error > 0x1p-900 && std::abs(far - near) > error) return far > near;
  const ExactVector exact = difference(p, light.center);
  const Exact r(light.radius);
  return CGAL::sign(exact.x * exact.x + exact.y * exact.y + exact.z * exact.z - r * r) == CGAL::POSITIVE;
}

}  // namespace

bool above_horizon(const Light& light, const std::array<glm::vec3, 3>& carrier, std::int8_t facing,
                   const glm::vec3& l) {
  return sign_above(light, carrier, l) * facing > 0;
}

bool in_front_of_light(const Light& light, const glm::vec3& p) {
  if (light.sun) return true;
  if (is_body(light.kind)) return outside_sphere(light, p);
  const Side side = side_of_plane(light.center, light.center_u, light.center_v, p);
  return light.two_sided ? side != Side::on : side == Side::front;
}

PairTruth decide_pair(const SceneFloats& scene, const ViewSamples& samples, std::size_t pixel, const Light& light,
                      std::uint32_t light_sample) {
  PENUMBRA_ASSERT(pixel < samples.size() && samples.triangle[pixel] != ViewSamples::kBackground, "pixel {}", pixel);
  PENUMBRA_ASSERT(light_sample < light.sample_count(), "light sample {} of {}", light_sample, light.sample_count());
  const auto carrier = static_cast<std::uint32_t>(samples.triangle[pixel]);
  const glm::vec3& p = samples.p[pixel];
  // Inside a sphere no light points are defined that could be above or below a plane.
  if (is_body(light.kind) && !in_front_of_light(light, p)) return {PairOutcome::behind, false};
  std::vector<glm::vec3> points(light.sample_count());
  light_points_for(light, p, points.data());
  const glm::vec3& l = points[light_sample];

  const std::array<glm::vec3, 3> corners = scene.corners(carrier);
  const int above = sign_above(light, corners, l) * samples.facing[pixel];
  if (above <= 0) return {PairOutcome::horizon, above == 0};
  if (!in_front_of_light(light, p)) {
    return {PairOutcome::behind, side_of_plane(light.center, light.center_u, light.center_v, p) == Side::on};
  }
  // A triangle that is met without doubt decides the pair; one that is met only by the resolution of a zero is
  // recorded.
  PairTruth truth;
  for (std::uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) {
    if (!may_occlude(scene, light, carrier, triangle)) continue;
    const std::array<glm::vec3, 3> occluder = scene.corners(triangle);
    if (!boxes_touch(p, l, occluder, light)) continue;
    const Meeting meeting = segment_meets_triangle(p, l, occluder, light);
    if (meeting.meets) truth.outcome = PairOutcome::blocked;
    if (meeting.meets && !meeting.zero_predicate) return {PairOutcome::blocked, false};
    truth.zero_predicate |= meeting.zero_predicate;
  }
  if (truth.outcome != PairOutcome::visible) return truth;
  for (const std::uint32_t triangle : scene.alphas.casters) {
    if (alpha_mode(scene, triangle) != scenes::Alpha::Mode::mask || !may_filter(scene, light, carrier, triangle))
      continue;
    const std::array<glm::vec3, 3> mask = scene.corners(triangle);
    if (!boxes_touch(p, l, mask, light)) continue;
    const Meeting meeting = segment_meets_triangle(p, l, mask, light);
    truth.zero_predicate |= meeting.zero_predicate;
    if (!meeting.meets) continue;
    truth.by_mask = true;
    const glm::dvec3 shares = shares_on_line(glm::dvec3(p), direction_to(light, p, l), mask);
    if (transmittance_at(scene, triangle, shares) == 0) truth.outcome = PairOutcome::blocked;
  }
  return truth;
}

}  // namespace penumbra::visibility
