// SPDX-License-Identifier: Apache-2.0
// Distributes points over a light (R2 sequence, Roberts 2018) and maps the unit square to a light's shape (Shirley and
// Chiu 1997).

#include "maps/products/light_shape.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace penumbra::maps {
namespace {

/// Returns point i of the R2 sequence (Roberts 2018): multiples of the two-dimensional golden ratio, modulo 1.
glm::dvec2 r2_point(std::uint32_t i) {
  constexpr double kPlastic = 1.32471795724474602596;  // x³ = x + 1
  const glm::dvec2 step{1 / kPlastic, 1 / (kPlastic * kPlastic)};
  return glm::fract(glm::dvec2(0.5) + static_cast<double>(i) * step);
}

/// Returns point i of the R2 sequence, mapped to the unit disk with equal areas.
glm::dvec2 disk_point(std::uint32_t i) {
  const glm::dvec2 at = r2_point(i);
  const double radius = std::sqrt(at.x), angle = 2 * std::numbers::pi * at.y;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Area-preserving map from the unit square to a flat convex polygon: a fan around its first corner.
class Fan {
 public:
  explicit Fan(std::vector<glm::dvec2> corners) : corners_(std::move(corners)), area_up_to_(corners_.size() - 1, 0.0) {
    for (std::size_t i = 1; i + 1 < corners_.size(); ++i) {
      const glm::dvec2 b = corners_[i] - corners_[0], c = corners_[i + 1] - corners_[0];
      area_up_to_[i] = area_up_to_[i - 1] + std::abs(b.x * c.y - b.y * c.x);
    }
  }
  [[nodiscard]] glm::dvec2 at(const glm::dvec2& unit) const {
    const double along = unit.x * area_up_to_.back();
    std::size_t i = 1;
    while (i + 1 < area_up_to_.size() && along >= area_up_to_[i]) ++i;
    const double width = area_up_to_[i] - area_up_to_[i - 1];
    const double share = width > 0 ? std::clamp((along - area_up_to_[i - 1]) / width, 0.0, 1.0) : 0.5;
    return glm::mix(corners_[0], glm::mix(corners_[i], corners_[i + 1], share), std::sqrt(unit.y));
  }

 private:
  std::vector<glm::dvec2> corners_;
  std::vector<double> area_up_to_;
};

}  // namespace

std::vector<glm::vec2> light_pattern(const visibility::Light& light, const LightBasis& basis, std::uint32_t count) {
  std::vector<glm::vec2> pattern(count);
  if (is_circle(light.kind)) {
    for (std::uint32_t i = 0; i < count; ++i) pattern[i] = light.radius * disk_point(i);
    return pattern;
  }
  if (is_round(light.kind)) {
    const LightAxes axes = light_axes(light, basis);
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::dvec2 at = disk_point(i);
      pattern[i] = at.x * axes.u + at.y * axes.v;
    }
    return pattern;
  }
  const Fan fan(light_outline(light, basis));
  for (std::uint32_t i = 0; i < count; ++i) pattern[i] = fan.at(r2_point(i));
  return pattern;
}

LightSquare::LightSquare(const visibility::Light& light)
    : light_(&light), frame_(visibility::light_frame(light)), centroid_(visibility::center_of(light)) {
  if (!is_polygon(light.kind)) return;
  area_up_to_ = {0.0};
  for (std::size_t i = 0; i < light.outline.size(); ++i) {
    const glm::dvec3 a(light.outline[i]), b(light.outline[(i + 1) % light.outline.size()]);
    area_up_to_.push_back(area_up_to_.back() + glm::length(glm::cross(a - centroid_, b - centroid_)));
  }
  for (double& area : area_up_to_) area /= area_up_to_.back();
}

glm::dvec3 LightSquare::outline(double share) const {
  if (is_round(light_->kind)) {
    const double angle = 2 * std::numbers::pi * (share - 0.375);  // the square's lower left corner: 225 degrees
    return frame_.center + std::cos(angle) * frame_.u + std::sin(angle) * frame_.v;
  }
  const auto count = light_->outline.size();
  std::size_t i = 0;
  while (i + 1 < count && share >= area_up_to_[i + 1]) ++i;
  const double swept = area_up_to_[i + 1] - area_up_to_[i];
  const double along = swept > 0 ? std::clamp((share - area_up_to_[i]) / swept, 0.0, 1.0) : 0.5;
  return glm::mix(glm::dvec3(light_->outline[i]), glm::dvec3(light_->outline[(i + 1) % count]), along);
}

glm::vec3 LightSquare::at(const glm::dvec2& unit) const {
  const double a = 2 * unit.x - 1, b = 2 * unit.y - 1;
  if (is_parallelogram(light_->kind)) return glm::vec3(frame_.center + a * frame_.u + b * frame_.v);
  const double ring = std::max(std::abs(a), std::abs(b));
  if (ring == 0) return glm::vec3(centroid_);
  // Position on the ring, from its lower left corner and counter-clockwise: a quarter for each side.
  double quarters = 0;
  if (b == -ring) {
    quarters = (a / ring + 1) / 2;
  } else if (a == ring) {
    quarters = 1 + (b / ring + 1) / 2;
  } else if (b == ring) {
    quarters = 2 + (1 - a / ring) / 2;
  } else {
    quarters = 3 + (1 - b / ring) / 2;
  }
  return glm::vec3(glm::mix(centroid_, outline(quarters / 4), ring));
}

LightPattern::LightPattern(const render::Device& device, std::initializer_list<std::uint32_t> counts)
    : counts_(counts),
      points_(device, "light pattern",
              std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}) * sizeof(glm::vec2)) {}

void LightPattern::record(render::Commands& /*commands*/, const MapSet& maps) {
  std::vector<glm::vec2> points;
  for (const std::uint32_t count : counts_) {
    const std::vector<glm::vec2> part = light_pattern(maps.light, maps.basis, count);
    points.insert(points.end(), part.begin(), part.end());
  }
  points_.write<glm::vec2>(points);
}

double half_width(const visibility::Light& light) {
  return std::sqrt(light.area / std::numbers::pi);
}

glm::dvec2 half_extent(const visibility::Light& light, const LightBasis& basis) {
  const LightBounds bounds = light_bounds(light, basis);
  return glm::max(-bounds.lower, bounds.upper);
}

}  // namespace penumbra::maps
