// SPDX-License-Identifier: Apache-2.0
#pragma once

// The place where edge-scatter computes an edge to cross the row of a light sample, and the exact place. A search
// maximises their difference relative to its bound.

#include "base/size1.hpp"
#include "tests/agreement/device_twins.hpp"
#include "tests/agreement/most_used.hpp"
#include "visibility/lights/device_light.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace penumbra::tests {

/// An edge's ends on the light as computed, in cells, and the bounds of their errors.
struct PlacedEnds {
  std::array<glm::vec2, 2> at{};
  std::array<float, 2> error{};
};
/// A light sample of a row: in column `column`, before the row's shift.
struct CellOfRow {
  float row = 0, column = 0, shift = 0;
};

/// Returns the exact distance from the light sample to the place where the edge (a, b) crosses the sample's row, in
/// columns. `step` leads from one column to the next.
inline long double exact_crossing(const glm::vec3& p, const glm::vec3& l, const std::array<glm::vec3, 2>& edge,
                                  const glm::dvec3& step) {
  using Exact = glm::tvec3<long double>;
  const Exact from(p), normal = glm::cross(Exact(edge[0]) - from, Exact(edge[1]) - from);
  return -glm::dot(normal, Exact(l) - from) / glm::dot(normal, Exact(step));
}

/// Returns the same distance as both engines compute it (docs/edge-scatter.md, Crossing), or an empty result if the
/// edge ends near the row.
inline Rounded crossing_as_rounded(const PlacedEnds& ends, const glm::vec2& half_cells, const CellOfRow& sample,
                                   long double exact) {
  constexpr float kRound = 0x1p-24F;
  const glm::vec2 first_cell = half_cells - 0.5F;
  const auto& [a, b] = ends.at;
  const glm::vec2 to_a = glm::abs(a - first_cell), to_b = glm::abs(b - first_cell);
  const bool turn = to_b.x + to_b.y < to_a.x + to_a.y;
  const glm::vec2 near = turn ? b : a, far = turn ? a : b, low = glm::min(a, b), high = glm::max(a, b);
  const auto [error_near, error_far] = std::pair(ends.error.at(turn ? 1 : 0), ends.error.at(turn ? 0 : 1));
  if (!(low.y + error_near + error_far < sample.row && sample.row < high.y - error_near - error_far)) return {};
  const float slope = (far.x - near.x) / (far.y - near.y), steep = std::abs(slope);
  const float x = std::clamp(near.x + (sample.row - near.y) * slope, low.x, high.x);
  const float weight = std::min(1.0F, (std::abs(near.y - first_cell.y) + 2 * half_cells.y) / std::abs(far.y - near.y));
  const float bound =
      1.2F * (error_near + weight * error_far) * (1 + steep) + 8 * kRound * (half_cells.x + std::abs(near.x));
  return {(x - sample.shift) - sample.column, exact, static_cast<long double>(bound)};
}

/// Computes where a point appears from p as the device does, and the bound of the error (docs/edge-scatter.md, X). The
/// light's plane must not cut the scene.
class DevicePlaces {
 public:
  DevicePlaces(const visibility::DeviceLight& light, const glm::vec3& p, const glm::vec2& half_cells)
      : frame_(light, p, half_cells),
        half_cells_(half_cells),
        per_length_(std::max(glm::length(frame_.across), glm::length(frame_.along))),
        skew_(size1(light.u) * size1(light.v) / glm::length(glm::cross(light.u, light.v))),
        away_(glm::length(p - light.center)),
        deviation_(light.deviation) {}

  [[nodiscard]] PlacedEnds operator()(const std::array<glm::vec3, 2>& edge) const {
    PlacedEnds placed;
    for (std::size_t i = 0; i < 2; ++i) {
      const glm::vec3 d = edge.at(i) - frame_.p;
      const float w = -glm::dot(frame_.axis, d), q = frame_.height / w;
      placed.at.at(i) = frame_.foot + q * glm::vec2(glm::dot(frame_.across, d), glm::dot(frame_.along, d));
      placed.error.at(i) = error_of(glm::length(d), w, glm::length(placed.at.at(i) - frame_.foot));
    }
    return placed;
  }

 private:
  [[nodiscard]] float error_of(float far, float w, float from_foot) const {
    const float height = frame_.height, q = height / w;
    return 0x1p-24F * (4 * per_length_ * far * q + from_foot * (4 * far / w + 4 * away_ / height + 8) +
                       per_length_ * 4 * away_ + 16 * skew_ * (half_cells_.x + half_cells_.y) * (1 + far / w)) +
           (per_length_ + from_foot / height) * deviation_;
  }

  twins::Frame<float> frame_;
  glm::vec2 half_cells_;
  float per_length_, skew_, away_, deviation_;
};

/// Returns a triangle between p and the light sample l whose first side passes through the segment from p to l, up to
/// the rounding of its corners to floats. `numbers` come from a search and choose place, direction and size. `width` is
/// the light's.
inline std::array<glm::dvec3, 3> triangle_at(const glm::dvec3& p, const glm::dvec3& l, double width, Numbers& numbers) {
  const glm::dvec3 direction = l - p, across = numbers.vector() + glm::dvec3(0x1p-30);
  const double share = 0.1 + 0.8 * numbers.next(), size = share * width * std::exp2(1 - 2 * numbers.next());
  const glm::dvec3 at = p + share * direction, e = glm::normalize(across), f = glm::normalize(glm::cross(direction, e));
  return {at - size * (0.2 + 0.8 * numbers.next()) * e, at + size * (0.2 + 0.8 * numbers.next()) * e, at + size * f};
}

}  // namespace penumbra::tests
