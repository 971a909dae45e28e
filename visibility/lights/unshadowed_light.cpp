// SPDX-License-Identifier: Apache-2.0
// Form factors of an unoccluded light and of its parts, with horizon and emitting side.

#include "visibility/lights/unshadowed_light.hpp"

#include "base/assert.hpp"
#include "visibility/lights/disk_part.hpp"
#include "visibility/lights/form_factor.hpp"
#include "visibility/lights/kinds/light_kinds.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::visibility {

UnshadowedLight::UnshadowedLight(const Light& light, const glm::vec3& p, const glm::vec3& n)
    : light_(light), p_(p), n_(glm::normalize(glm::dvec3(n))) {
  const LightFrame frame = light_frame_from(light, p);
  center_ = light.sun ? frame.center : frame.center - p_;
  u_ = frame.u;
  v_ = frame.v;
  if (is_body(light.kind)) {
    radius_ = glm::length(u_);
    side_ = in_front_of_light(light, p) && radius_ > 0 ? 1 : 0;
    if (side_ != 0) along_ = glm::normalize(glm::dvec3(light.center) - p_);
  } else if (light.sun) {
    radius_ = light.sun->tangent;
    along_ = glm::normalize(center_);
    side_ = 1;
  } else {
    radius_ = light.radius;
    const glm::dvec3 front = glm::normalize(glm::cross(u_, v_));
    // The side is exact, as for a pair; a point of the plane itself is on neither side.
    const Side side = side_of_plane(light.center, light.center_u, light.center_v, p);
    if (side == Side::front) side_ = 1;
    if (side == Side::back && light.two_sided) side_ = -1;
    along_ = side == Side::front ? -front : front;
  }
  height_ = glm::dot(n_, center_);
  height_u_ = glm::dot(n_, u_);
  height_v_ = glm::dot(n_, v_);
}

bool UnshadowedLight::above_horizon() const {
  return behaviour_of(light_.kind).is_above_horizon(*this);
}

double UnshadowedLight::whole() const {
  return shines() ? behaviour_of(light_.kind).form_factor(*this) : 0;
}

double UnshadowedLight::part(std::span<const glm::dvec2> corners) const {
  if (!shines() || corners.empty()) return 0;
  if (is_round(light_.kind)) return part_of_disk(corners);
  const auto point = [&](const glm::dvec2& st) { return center_ + st.x * u_ + st.y * v_; };
  const auto height = [&](const glm::dvec2& st) { return height_ + st.x * height_u_ + st.y * height_v_; };
  FormFactorLoop loop(n_);
  glm::dvec2 from = corners.back();
  glm::dvec3 a = point(from);
  double height_a = height(from);
  for (const glm::dvec2& to : corners) {
    const glm::dvec3 b = point(to);
    const double height_b = height(to);
    const glm::dvec2 step = to - from;
    loop.add({a, b, step.x * u_ + step.y * v_}, height_a, height_b);
    from = to;
    a = b;
    height_a = height_b;
  }
  return -side_ * loop.sum();  // counter-clockwise in (s, t) is the orientation as seen from the front
}

double UnshadowedLight::part_of_disk(std::span<const glm::dvec2> corners) const {
  // The horizon cuts the polygon first, so that all remaining parts of the rim are above it.
  std::array<glm::dvec2, DiskPart::kMostCorners> above;
  std::size_t count = 0;
  const auto height = [&](const glm::dvec2& st) { return height_ + st.x * height_u_ + st.y * height_v_; };
  PENUMBRA_ASSERT(corners.size() + 2 <= above.size(), "{} corners", corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 &a = corners[i], &b = corners[i + 1 < corners.size() ? i + 1 : 0];
    const double height_a = height(a), height_b = height(b);
    if (height_a >= 0) above[count++] = a;
    if ((height_a >= 0) != (height_b >= 0)) above[count++] = a + height_a / (height_a - height_b) * (b - a);
  }
  const auto direction = [&](const glm::dvec2& st) { return st.x * u_ + st.y * v_; };
  double sum = 0;
  const DiskPart seen{std::span(above).first(count)};
  for (const auto& [from, to, arc] : seen.pieces()) {
    sum +=
        form_factor_term(FormFactorEdge{center_ + direction(from), center_ + direction(to), direction(to - from)}, n_);
    if (arc != 0) sum += form_factor_arc({center_, u_, v_, std::atan2(to.y, to.x), arc}, n_);
  }
  return -side_ * sum;
}

double UnshadowedLight::box(const glm::dvec2& low, const glm::dvec2& high) const {
  const std::array<glm::dvec2, 4> corners{low, {high.x, low.y}, high, {low.x, high.y}};
  return std::max(0.0, part(corners));
}

}  // namespace penumbra::visibility
