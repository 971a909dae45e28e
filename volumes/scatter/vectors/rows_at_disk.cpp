// rows=exact of a sphere that casters reach into: only what is before the disk that a view sample sees hides it.
// docs/edge-scatter.md, "Ends".

#include "engines/vectors/near_casters.hpp"
#include "mesh/predicates.hpp"
#include "volumes/scatter/vectors/rows.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace penumbra::volumes {

using vectors::NearCasters;
using vectors::NearSpheres;

/// What double makes of how high over the disk's plane a way ends: m is off by as much as error_height_ says, and what
/// is λ times as far away by λ times that.
double RowSum::error_over_disk(const Way& way) const {
  return way.error_up + error_height_ * std::max(1.0, way.to.z / height_);
}

/// −1: before it; 1: behind; 0: rounding hides on which side.
int RowSum::side_of_disk(const Way& way) const {
  const double over = way.to.z - height_;
  if (!(std::abs(over) > 4 * error_over_disk(way))) return 0;
  return over > 0 ? 1 : -1;
}

/// Where the segment between ends on either side of the plane passes through it: always of the lexicographically first
/// one, so that all edges that end there have the same numbers. (bound pass)
RowSum::Way RowSum::pass_disk(const Way& first, const Way& second) const {
  const double across = first.to.z - second.to.z, share = (first.to.z - height_) / across;
  const glm::dvec2 aside = glm::dvec2(second.to) - glm::dvec2(first.to), to = glm::dvec2(first.to) + share * aside;
  const double size = std::abs(aside.x) + std::abs(aside.y),
               error_up = std::max(error_over_disk(first), error_over_disk(second));
  return {{to.x, to.y, height_},
          2 * (std::max(first.error, second.error) + size * error_up / std::abs(across)),
          0,
          std::max(first.length, second.length)};
}

void RowSum::cut_at_disk() {
  cuts_at_disk_ = true;
  const NearSpheres& near = *grid_.cones->near;
  const auto column = [&](std::size_t field) { return near.columns[field].data(); };
  const double *x = column(NearSpheres::kMiddle), *y = column(NearSpheres::kMiddle + 1),
               *z = column(NearSpheres::kMiddle + 2), *radius = column(NearSpheres::kRadius),
               *number = column(NearSpheres::kNumber);
  // A sphere that is off the plane by a thousandth of its radius, or of its distance, is on that side of it for sure:
  // rounding is far less, as long as p is not on the light (is_open_).
  for (std::size_t i = 0; i < near.count && !is_open_; ++i) {
    const glm::dvec3 from = glm::dvec3(x[i], y[i], z[i]) - p_;
    const double over = std::abs(glm::dot(axes_[2], from) + height_);
    if (over > radius[i] + 0.001 * (radius[i] + height_)) continue;
    add_disk_cut(static_cast<std::size_t>(number[i]));
  }
}

void RowSum::add_disk_cut(std::size_t caster) {
  const double* row = &grid_.cones->casters->rows[caster * NearCasters::kRow];
  if (row[NearCasters::kPlane] == static_cast<double>(plane_)) return;  // its own plane hides nothing
  std::array<glm::dvec3, 3> corners;
  std::array<Way, 3> ways;
  std::array<int, 3> sides{};
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = {row[3 * i], row[3 * i + 1], row[3 * i + 2]};
    ways[i] = way_to(corners[i]);
    sides[i] = side_of_disk(ways[i]);
    low = glm::min(low, glm::dvec2(ways[i].to));
    high = glm::max(high, glm::dvec2(ways[i].to));
  }
  if (std::abs(sides[0] + sides[1] + sides[2]) == 3) return;
  // A way that ends at the plane appears as far aside of the foot as it goes. One more cell has room for rounding.
  if (glm::any(glm::lessThan(foot_ + high, glm::dvec2(-1))) ||
      glm::any(glm::greaterThan(foot_ + low, 2.0 * glm::dvec2(grid_.half_cells) + 1.0)))
    return;
  if (sides[0] * sides[1] * sides[2] == 0) {
    is_open_ = true;
    return;
  }
  const mesh::Side turn = mesh::side_of_plane(corners[0], corners[1], corners[2], p_);
  if (turn == mesh::Side::on) return;
  // Around what is before the plane, the corners in their order: out of it at `from`, back at `to`.
  Way from, to;
  for (const auto& [i, next] : {std::pair{0U, 1U}, std::pair{1U, 2U}, std::pair{2U, 0U}}) {
    if (sides[i] == sides[next]) continue;
    (sides[i] < 0 ? from : to) = pass_disk(ways[std::min(i, next)], ways[std::max(i, next)]);
  }
  const glm::dvec2 a = glm::dvec2(from.to), b = glm::dvec2(to.to), place_a = foot_ + a, place_b = foot_ + b;
  const double far = std::max(std::abs(a.x) + std::abs(a.y), std::abs(b.x) + std::abs(b.y));
  add({place_a.x, place_a.y, place_b.x, place_b.y, turn == mesh::Side::front ? 1 : -1},
      placing_error(height_, std::max(from.error, to.error), 0, far));
}

}  // namespace penumbra::volumes
