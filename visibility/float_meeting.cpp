// SPDX-License-Identifier: Apache-2.0
// Tests whether rays of one direction meet a triangle; gives an answer only where float32 arithmetic cannot disagree.

#include "visibility/float_meeting.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace penumbra::visibility {
namespace {

/// Returns −1 or 1; 0 if the value may have any sign.
int sign_beyond(double value, double doubt) {
  return value > doubt ? 1 : value < -doubt ? -1 : 0;
}

}  // namespace

glm::dvec3 wide_cross(const glm::dvec3& x, const glm::dvec3& y) {
  return {x.y * y.z + x.z * y.y, x.z * y.x + x.x * y.z, x.x * y.y + x.y * y.x};
}

RayStarts::RayStarts(const glm::vec3& lower, const glm::vec3& upper)
    : middle((glm::dvec3(lower) + glm::dvec3(upper)) / 2.0), half(glm::dvec3(upper) - middle) {
  const glm::dvec3 far = glm::abs(middle) + half;
  room = 0x1p-3 * std::max({far.x, far.y, far.z});
}

FloatMeeting float_rays_meet(const RayStarts& starts, const glm::dvec3& direction,
                             const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a = glm::dvec3(corners[0]) - starts.middle, b = glm::dvec3(corners[1]) - starts.middle,
                   c = glm::dvec3(corners[2]) - starts.middle;
  const glm::dvec3 around = starts.half + starts.room, wide = glm::abs(direction);
  const glm::dvec3 wide_a = glm::abs(a) + around, wide_b = glm::abs(b) + around, wide_c = glm::abs(c) + around;
  // The side of the edge from x to y on which the ray passes is the sign of d · (x × y) = d · (x × (y − x)). Its terms
  // are those of d · ((y − x) × (y + x)), which Embree's robust rays compute; moving the start by δ changes it by d ·
  // ((x − y) × δ), which the room in `wide_x` and `wide_y` covers. The value is linear in the start, so its least and
  // greatest values are at the box's corners.
  const auto side = [&](const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& wide_x, const glm::dvec3& wide_y) {
    const glm::dvec3 edge = y - x;
    const double spread = glm::dot(glm::abs(glm::cross(edge, direction)), starts.half);
    return sign_beyond(glm::dot(direction, glm::cross(x, edge)),
                       spread + kFloatDoubt * glm::dot(wide, wide_cross(glm::abs(edge), wide_x + wide_y)));
  };
  const int ab = side(a, b, wide_a, wide_b), bc = side(b, c, wide_b, wide_c);
  if (ab * bc < 0) return FloatMeeting::no;
  const int ca = side(c, a, wide_c, wide_a);
  if (ab * ca < 0 || bc * ca < 0) return FloatMeeting::no;
  // The three sides add up to n · direction, n = (b − a) × (c − a): if they have one sign, that is its sign, too. The
  // ray's parameter at the plane is n · a divided by n · direction.
  if (ab == 0 || bc == 0 || ca == 0) return FloatMeeting::maybe;
  const glm::dvec3 to_b = b - a, to_c = c - a, n = glm::cross(to_b, to_c);
  const double doubt =
      glm::dot(glm::abs(n), starts.half) + kFloatDoubt * glm::dot(wide_cross(glm::abs(to_b), glm::abs(to_c)), wide_a);
  const int before = ab * sign_beyond(glm::dot(n, a), doubt);
  return before > 0 ? FloatMeeting::surely : before < 0 ? FloatMeeting::no : FloatMeeting::maybe;
}

}  // namespace penumbra::visibility
