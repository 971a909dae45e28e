// SPDX-License-Identifier: Apache-2.0
// rows=exact for a sphere that casters reach into: only objects in front of the disk that a view sample sees hide it.
// docs/edge-scatter.md, "Ends".

#include "engines/vectors/near_casters.hpp"
#include "mesh/predicates.hpp"
#include "volumes/scatter/vectors/rows.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace penumbra::volumes {

using vectors::NearCasters;
using vectors::NearSpheres;

/// Returns the rounding error, in double, of the height of a vector's end over the disk's plane. The disk's middle m is
/// off by error_height_, and a point λ times as far away by λ times that.
double RowSum::error_over_disk(const Direction& direction) const {
  return direction.error_up + error_height_ * std::max(1.0, direction.to.z / height_);
}

/// Returns −1 for a point in front of the disk; 1 behind; 0 if rounding leaves the side open.
int RowSum::side_of_disk(const Direction& direction) const {
  const double over = direction.to.z - height_;
  if (!(std::abs(over) > 4 * error_over_disk(direction))) return 0;
  return over > 0 ? 1 : -1;
}

/// Returns the crossing of the plane by the segment between ends on either side: always computed from the
/// lexicographically first one, so that all edges that end there have the same numbers. (bound pass)
RowSum::Direction RowSum::pass_disk(const Direction& first, const Direction& second) const {
  const double across = first.to.z - second.to.z, share = (first.to.z - height_) / across;
  const glm::dvec2 aside = glm::dvec2(second.to) - glm::dvec2(first.to), to = glm::dvec2(first.to) + share * aside;
  const double size = std::abs(aside.x) + std::abs(aside.y),
               error_up = std::max(error_over_disk(first), error_over_disk(second));
  return {{to.x, to.y, height_},
          2 * (std::max(first.error, second.error) + size * error_up / std::abs(across)),
          std::max(first.error_up, second.error_up),
          std::max(first.length, second.length)};
}

void RowSum::cut_at_disk(const GridSample& at) {
  cuts_at_disk_ = true;
  const LightCone& cone = grid_.cones->of[at.cone];
  // A sphere that does not reach the square around the disk never intersects the square, regardless of other nearby
  // casters: so no result depends on casters near other view samples. (The square's corners are √2 of the axes away;
  // the excess in the factor covers rounding.)
  const double to_corner = 1.5 * std::max(glm::length(cone.u), glm::length(cone.v));
  const NearSpheres& near = *grid_.cones->near;
  const auto column = [&](std::size_t field) { return near.columns[field].data(); };
  const double *x = column(NearSpheres::kMiddle), *y = column(NearSpheres::kMiddle + 1),
               *z = column(NearSpheres::kMiddle + 2), *radius = column(NearSpheres::kRadius),
               *number = column(NearSpheres::kNumber);
  // A sphere that is off the plane by more than a thousandth of its radius and of its distance is on that side of it:
  // rounding is less than 2⁻⁴⁰ of either, since no cone is flatter than tan⁻¹ 256.
  for (std::size_t i = 0; i < near.count && !is_open_; ++i) {
    const glm::dvec3 from = glm::dvec3(x[i], y[i], z[i]) - p_;
    const double over = std::abs(glm::dot(axes_[2], from) + height_);
    if (over > radius[i] + 0.001 * (radius[i] + height_)) continue;
    if (glm::length(from - cone.middle) > radius[i] + to_corner) continue;
    add(place_disk_cut(static_cast<std::size_t>(number[i])));
  }
}

std::optional<RowSum::Placed> RowSum::place_disk_cut(std::size_t caster) {
  const double* row = &grid_.cones->casters->rows[caster * NearCasters::kRow];
  if (row[NearCasters::kPlane] == static_cast<double>(plane_)) return std::nullopt;  // p's own plane hides nothing
  std::array<glm::dvec3, 3> corners;
  std::array<Direction, 3> directions;
  std::array<int, 3> sides{};
  RowEdge box{INFINITY, INFINITY, -INFINITY, -INFINITY, 0};  // bounds of the places of its corners, in the disk's plane
  double error = 0, error_up = 0, far = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = {row[3 * i], row[3 * i + 1], row[3 * i + 2]};
    directions[i] = direction_to(corners[i]);
    sides[i] = side_of_disk(directions[i]);
    const glm::dvec2 aside(directions[i].to);
    box = {std::min(box.x0, foot_.x + aside.x), std::min(box.y0, foot_.y + aside.y),
           std::max(box.x1, foot_.x + aside.x), std::max(box.y1, foot_.y + aside.y), 0};
    far = std::max(far, std::abs(aside.x) + std::abs(aside.y));
    error = std::max(error, directions[i].error);
    error_up = std::max(error_up, directions[i].error_up);
  }
  if (std::abs(sides[0] + sides[1] + sides[2]) == 3) return std::nullopt;
  if (sides[0] * sides[1] * sides[2] == 0) {
    // All crossings of the triangle's edges with the plane lie between the places of its corners.
    is_open_ = is_open_ || !is_beside(box, kUnsure * placing_error(1, error, error_up, far));
    return std::nullopt;
  }
  // Walks around the part of the triangle in front of the plane, with the corners in order: the boundary leaves at
  // `from`, and returns at `to`.
  Direction from, to;
  for (const auto& [i, next] : {std::pair{0U, 1U}, std::pair{1U, 2U}, std::pair{2U, 0U}}) {
    if (sides[i] != sides[next])
      (sides[i] < 0 ? from : to) = pass_disk(directions[std::min(i, next)], directions[std::max(i, next)]);
  }
  const glm::dvec2 a = foot_ + glm::dvec2(from.to), b = foot_ + glm::dvec2(to.to);
  const RowEdge edge{a.x, a.y, b.x, b.y, 0};
  far = std::max(std::abs(from.to.x) + std::abs(from.to.y), std::abs(to.to.x) + std::abs(to.to.y));
  const double off = placing_error(1, std::max(from.error, to.error), std::max(from.error_up, to.error_up), far);
  if (is_beside(edge, off)) return std::nullopt;
  const mesh::Side turn = mesh::side_of_plane(corners[0], corners[1], corners[2], p_);
  if (turn == mesh::Side::on) return std::nullopt;
  return Placed{{a.x, a.y, b.x, b.y, turn == mesh::Side::front ? 1 : -1}, off};
}

}  // namespace penumbra::volumes
