// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/skies/sky_texels.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

/// The walk of SkyTexels along a great circle, from border to border of texels. Inside visibility/skies/ only.
namespace penumbra::visibility {

/// Walks along an arc whose latitude only rises or only falls. On the circle the slope at an azimuth is −(axis.x cos φ
/// + axis.y sin φ) / axis.z: comparing slopes shows which border comes first, without computing angles.
template <typename Visit>
void SkyTexels::walk_monotone(const SkyArc& arc, Place& at, Place end, const Visit& visit) const {
  const glm::dvec3& axis = arc.axis;
  const bool east = axis.z > 0, rises = end.slope > at.slope;
  const auto modulo = [&](std::size_t a, std::size_t b) { return (a + columns_ - b) % columns_; };
  std::size_t left = east ? modulo(end.cell.column, at.cell.column) : modulo(at.cell.column, end.cell.column);
  if (left > columns_ / 2 + 1) {  // the end is behind by rounding
    left = 0;
    end.point.across = across_of(at.cell.column, end.point.cosine, end.point.sine);
  }
  const double level = std::hypot(axis.x, axis.y);
  for (;;) {
    SkyCell& cell = at.cell;
    const std::size_t meridian = east ? cell.column + 1 : cell.column;
    const glm::dvec2& direction = meridians_[meridian];
    const double slope = left > 0 ? -(axis.x * direction.x + axis.y * direction.y) / axis.z : end.slope;
    const Border& border = borders_[rises ? cell.row : cell.row + 1];
    SkyPoint next;
    if (rises ? slope > border.slope && cell.row > 0 : slope < border.slope && cell.row + 1 < rows_) {
      // u and w are cosine and sine of the azimuth relative to the axis's azimuth; w is positive where the arc rises.
      const double u = std::clamp(-axis.z * border.slope / level, -1.0, 1.0);
      const double w = (rises ? 1 : -1) * std::sqrt((1 - u) * (1 + u));
      next.cosine = (axis.x * u - axis.y * w) / level;
      next.sine = (axis.y * u + axis.x * w) / level;
      next.latitude = border.latitude;
      next.across = across_of(cell.column, next.cosine, next.sine);
      next.turn = arc.turn_of({border.flat * next.cosine, border.flat * next.sine, border.z});
      visit(cell, at.point, next);
      rises ? --cell.row : ++cell.row;
    } else if (left > 0) {
      const double flat = 1 / std::sqrt(1 + slope * slope);
      next.cosine = direction.x;
      next.sine = direction.y;
      next.latitude = std::atan(slope);
      next.across = east ? width_ : 0;
      next.turn = arc.turn_of({flat * direction.x, flat * direction.y, flat * slope});
      visit(cell, at.point, next);
      cell.column = east ? (cell.column + 1) % columns_ : (cell.column + columns_ - 1) % columns_;
      next.across = east ? 0 : width_;
      --left;
    } else {
      visit(cell, at.point, end.point);
      at.point = end.point;
      at.slope = end.slope;
      return;
    }
    at.point = next;
  }
}

template <typename Visit>
void SkyTexels::walk(const SkyArc& arc, const Visit& visit) const {
  if (arc.is_empty) return;
  Place at = place_of(arc, arc.a);
  const double up_at_a = arc.along.z, up_at_b = glm::cross(arc.axis, arc.b).z;
  if (up_at_a * up_at_b < 0) {  // the highest or lowest direction is between
    const double level = std::hypot(arc.axis.x, arc.axis.y);
    const glm::dvec3 top(-arc.axis.z * arc.axis.x / level, -arc.axis.z * arc.axis.y / level, level);
    walk_monotone(arc, at, place_of(arc, up_at_a > 0 ? top : -top), visit);
  }
  walk_monotone(arc, at, place_of(arc, arc.b), visit);
}

}  // namespace penumbra::visibility
