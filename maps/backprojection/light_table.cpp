// SPDX-License-Identifier: Apache-2.0
// Computes tables of prefix sums (Crow 1984) of the area of a light, exact at the nodes.

#include "maps/backprojection/light_table.hpp"

#include "base/assert.hpp"
#include "visibility/lights/convex_polygon.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace penumbra::maps {
namespace {

constexpr std::uint32_t kCells = 256;
/// A rectangle light counts as its whole bounding rectangle if the rounding of its stored corners leaves out no more
/// than this fraction of the rectangle: V is off by no more than this. A light that leaves out more has a table, like a
/// polygon.
constexpr double kPerpendicular = 1e-6;

/// Returns ∫ √(1 − t²) dt from 0 to t.
double under_circle(double t) {
  return (t * std::sqrt(std::max(0.0, 1 - t * t)) + std::asin(t)) / 2;
}

/// Returns the area of the unit disk's part above the height y ≥ 0 and left of x.
double cap_left_of(double x, double y) {
  const double half = std::sqrt(std::max(0.0, 1 - y * y)), to = std::clamp(x, -half, half);
  return under_circle(to) - under_circle(-half) - y * (to + half);
}

/// Returns the fraction of the unit disk left of x and below y.
double disk_share(double x, double y) {
  x = std::clamp(x, -1.0, 1.0);
  const double left = 2 * (under_circle(x) - under_circle(-1));
  const double area = y < 0 ? cap_left_of(x, -y) : left - cap_left_of(x, std::min(y, 1.0));
  return area / std::numbers::pi;
}

std::vector<float> shares_of_texture(const visibility::LightTexture& texture) {
  // Rows of the texture run from the top downward.
  const std::size_t width = texture.width, height = texture.height;
  std::vector<double> sums((width + 1) * (height + 1), 0.0);
  for (std::size_t y = 0; y < height; ++y) {
    double row = 0;
    for (std::size_t x = 0; x < width; ++x) {
      row += texture.luminance[(height - 1 - y) * width + x];
      sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1] + row;
    }
  }
  std::vector<float> shares(sums.size());
  std::transform(sums.begin(), sums.end(), shares.begin(),
                 [&](double sum) { return static_cast<float>(sum / sums.back()); });
  return shares;
}

template <typename ShareOf>
std::vector<float> shares_at_nodes(const ShareOf& share_of) {
  std::vector<float> shares;
  shares.reserve(std::size_t{kCells + 1} * (kCells + 1));
  for (std::uint32_t y = 0; y <= kCells; ++y) {
    for (std::uint32_t x = 0; x <= kCells; ++x) {
      shares.push_back(static_cast<float>(share_of(glm::dvec2(x, y) / static_cast<double>(kCells))));
    }
  }
  return shares;
}

std::vector<float> shares_of_polygon(const std::vector<glm::dvec2>& outline, const LightBounds& bounds) {
  const double whole = visibility::area_of(outline);
  std::vector<float> shares;
  shares.reserve(std::size_t{kCells + 1} * (kCells + 1));
  for (std::uint32_t y = 0; y <= kCells; ++y) {
    const double top = glm::mix(bounds.lower.y, bounds.upper.y, y / static_cast<double>(kCells));
    const std::vector<glm::dvec2> below = visibility::clipped_above(outline, 1, top);
    for (std::uint32_t x = 0; x <= kCells; ++x) {
      const double right = glm::mix(bounds.lower.x, bounds.upper.x, x / static_cast<double>(kCells));
      shares.push_back(static_cast<float>(visibility::area_of(visibility::clipped_above(below, 0, right)) / whole));
    }
  }
  return shares;
}

}  // namespace

LightTableData light_table(const visibility::Light& light, const LightBasis& basis) {
  const LightBounds bounds = light_bounds(light, basis);
  LightTableData data{{bounds.lower, bounds.upper, 0, static_cast<float>(light.area), 0, kCells, kCells}, {}, {}};
  if (is_circle(light.kind)) {
    data.head.radius = static_cast<float>(light.radius);
    data.shares = shares_at_nodes([](const glm::dvec2& at) { return disk_share(2 * at.x - 1, 2 * at.y - 1); });
    return data;
  }
  const std::vector<glm::dvec2> outline = light_outline(light, basis);
  for (const glm::dvec2& corner : outline) {
    data.outline.push_back(static_cast<float>(corner.x));
    data.outline.push_back(static_cast<float>(corner.y));
  }
  data.head.corners = static_cast<std::uint32_t>(outline.size());
  const glm::dvec2 extent = bounds.upper - bounds.lower;
  const bool upright = is_parallelogram(light.kind) && std::abs(visibility::area_of(outline) - extent.x * extent.y) <=
                                                           kPerpendicular * extent.x * extent.y;
  if (!upright) {
    data.shares = shares_of_polygon(outline, bounds);
    return data;
  }
  data.head.width = light.texture ? light.texture->width : 1;
  data.head.height = light.texture ? light.texture->height : 1;
  data.shares = light.texture ? shares_of_texture(*light.texture) : std::vector<float>{0, 0, 0, 1};
  return data;
}

void LightTable::record(render::Commands& /*commands*/, const MapSet& maps) {
  write(light_table(maps.light, maps.basis));
}

void LightTable::write(const LightTableData& data) {
  const std::uint64_t head = sizeof(data.head), outline = data.outline.size() * sizeof(float);
  render::grow(*device_, table_, "light table", head + outline + data.shares.size() * sizeof(float));
  table_->write<gpu::LightTableHead>(std::span(&data.head, 1));
  if (outline > 0) table_->write<float>(data.outline, head);
  table_->write<float>(data.shares, head + outline);
}

const render::Buffer& LightTable::buffer() const {
  PENUMBRA_ASSERT(table_ != nullptr, "{}", "the light's table before the light");
  return *table_;
}

}  // namespace penumbra::maps
