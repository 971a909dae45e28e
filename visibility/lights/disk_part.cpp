// SPDX-License-Identifier: Apache-2.0
// Intersection of a convex polygon with the unit disk, edge by edge.

#include "visibility/lights/disk_part.hpp"

#include "base/assert.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::visibility {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

double angle(const glm::dvec2& from, const glm::dvec2& to) {
  return std::atan2(cross(from, to), glm::dot(from, to));
}

}  // namespace

DiskPart::DiskPart(std::span<const glm::dvec2> corners) {
  PENUMBRA_ASSERT(corners.size() <= kMostCorners, "{} corners", corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) add_edge(corners[i], corners[i + 1 < corners.size() ? i + 1 : 0]);
  if (count_ > 0) {
    pieces_[count_ - 1].arc += before_;
  } else if (std::abs(before_) > std::numbers::pi) {
    pieces_[count_++] = {{1, 0}, {1, 0}, std::copysign(2 * std::numbers::pi, before_)};
  }
}

void DiskPart::add_edge(const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 direction = b - a;
  const double length = glm::length(direction);
  if (length == 0) return;
  const glm::dvec2 along = direction / length;
  const double beside = cross(a, along);  // distance of the line from the centre
  const bool a_inside = glm::dot(a, a) <= 1, b_inside = glm::dot(b, b) <= 1;
  if (!a_inside && !b_inside && std::abs(beside) >= 1) return add_arc(angle(a, b));
  const glm::dvec2 foot = beside * glm::dvec2(along.y, -along.x);
  const double half = std::sqrt(std::max(0.0, 1 - beside * beside)), at_a = glm::dot(a, along),
               at_b = glm::dot(b, along);
  const double first = a_inside ? at_a : std::max(at_a, -half), last = b_inside ? at_b : std::min(at_b, half);
  if (!(first < last)) return add_arc(angle(a, b));
  const glm::dvec2 from = a_inside ? a : foot + first * along, to = b_inside ? b : foot + last * along;
  if (!a_inside) add_arc(angle(a, from));
  pieces_[count_++] = {from, to, 0};
  if (!b_inside) add_arc(angle(to, b));
}

void DiskPart::add_arc(double angle) {
  (count_ > 0 ? pieces_[count_ - 1].arc : before_) += angle;
}

double DiskPart::area() const {
  double twice = 0;
  for (const Piece& piece : pieces()) twice += cross(piece.from, piece.to) + piece.arc;
  return twice / 2;
}

}  // namespace penumbra::visibility
