// SPDX-License-Identifier: Apache-2.0
// Tests boxes of view samples against the thirteen half-spaces between a triangle and a box of light samples; see
// box_planes.hpp.

#include "vsm/box_planes.hpp"

#include "engines/pairs/blocked_samples.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace penumbra::vsm {

using pairs::kDeterminant;

BoxPlanes::BoxPlanes(const std::array<glm::dvec3, 3>& corners, const LightTree& tree, const LightTree::Node& light)
    : corners_(corners), off_(tree.box.off), sun_(tree.box.sun) {
  const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], normal = glm::cross(e1, e2);
  const double size = glm::length(e1) * glm::length(e2);
  int front = 0, back = 0;
  for (const glm::dvec3& l : light.corners) {
    const glm::dvec3 direction = sun_ ? l : l - corners[0];
    const double side = glm::dot(normal, direction), error = size * (kDeterminant * glm::length(direction) + off_);
    front += side > error ? 1 : 0;
    back += side < -error ? 1 : 0;
  }
  one_side_ = front == 4 || back == 4;
  // If l is in front of the triangle and p behind it, p sees the corners in the order that makes all f positive. In the
  // opposite case all f are negative.
  const double turn = back == 4 ? -1 : 1;
  for (std::size_t e = 0; e < 3; ++e) {
    const glm::dvec3 &a = corners[e], &b = corners[(e + 1) % 3];
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::dvec3& l = light.corners[i];
      const glm::dvec3 first = sun_ ? b - a : a - l, second = sun_ ? l : b - l;
      planes_[4 * e + i] = {turn * glm::cross(first, second), sun_ ? a : l,
                            kDeterminant * glm::length(first) * glm::length(second)};
    }
  }
  planes_[12] = {turn * normal, corners[0], kDeterminant * size};
}

BoxPlanes::Answer BoxPlanes::look(const ReceiverTree::Node& box, std::uint32_t& open) const {
  // The orientation of the edges differs between light samples, so no earlier result is valid.
  if (!one_side_) open |= kEdges;
  // Largest distance of the box's points p from each corner.
  std::array<double, 3> far{};
  for (std::size_t i = 0; i < 3; ++i) far[i] = glm::length(corners_[i] - box.middle) + box.radius;
  bool some_in = false, some_out = false;  // for some edge: the box is certainly in all, or outside of all, of its
                                           // half-spaces
  for (std::size_t e = 0; e < 3; ++e) {
    if ((open >> 4 * e & 15) == 0) {
      some_in = true;
      continue;
    }
    // If l moves by δl, f changes by up to |δl| |a − p| |b − p|; for a sun by up to |δl| |a − p| |b − a|.
    const double length = sun_ ? glm::length(corners_[(e + 1) % 3] - corners_[e]) : far[(e + 1) % 3];
    const double beside = off_ * far[e] * length;
    int out = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Plane& plane = planes_[4 * e + i];
      const glm::dvec3 direction = plane.base - box.middle;
      const double value = glm::dot(plane.normal, direction), reach = glm::dot(glm::abs(plane.normal), box.half);
      const double error = plane.relative * (glm::length(direction) + box.radius) + beside;
      if (value - reach > error) open &= ~(1U << (4 * e + i));
      out += value + reach < -error ? 1 : 0;
    }
    some_in = some_in || (open >> 4 * e & 15) == 0;
    some_out = some_out || out == 4;
  }
  if (some_out && (one_side_ || some_in)) return Answer::beside;
  if (!one_side_) return Answer::open;
  if ((open >> 12 & 1) != 0) {
    const Plane& plane = planes_[12];
    const double value = glm::dot(plane.normal, plane.base - box.middle),
                 reach = glm::dot(glm::abs(plane.normal), box.half), error = plane.relative * far[0];
    if (value + reach < -error) return Answer::beside;
    if (value - reach > error) open &= ~(1U << 12);
  }
  return open == 0 ? Answer::hidden : Answer::open;
}

}  // namespace penumbra::vsm
