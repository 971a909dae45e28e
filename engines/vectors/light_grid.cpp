// SPDX-License-Identifier: Apache-2.0
// Makes the grid of cells of a planar light, and the bounds of clusters of view samples. Error bounds:
// docs/edge-scatter.md.

#include "engines/vectors/light_grid.hpp"

#include "engines/vectors/cone_light.hpp"
#include "base/size1.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::vectors {
namespace {

float float_size1(const glm::dvec3& x) {
  return static_cast<float>(size1(x));
}

/// Returns the shift of a row in cells, as device passes compute it: (row · step) / 2¹⁶ modulo 1, in [−½, ½).
float shift_of(std::uint32_t row, std::uint32_t step) {
  return static_cast<float>(static_cast<int>((row * step + 32768U) & 0xffffU) - 32768) / 65536.0F;
}

/// Returns across, along (dot products with them give X and Y of a point in cells), and axis (of unit length, toward
/// `side`).
std::array<glm::dvec3, 3> axes_of(const glm::dvec3& u, const glm::dvec3& v, float side, const glm::vec2& half_cells) {
  const glm::dvec3 n = glm::cross(u, v);
  const double squared = glm::dot(n, n);
  return {glm::cross(v, n) / squared * static_cast<double>(half_cells.x),
          glm::cross(n, u) / squared * static_cast<double>(half_cells.y),
          static_cast<double>(side) * n / std::sqrt(squared)};
}

/// A point in the plane of a light's stored points.
struct Corner {
  glm::dvec3 at{0};
  double off = 0;
};
/// Returns the lower left corner of the rectangle around a light, moved into that plane.
Corner corner_around(const LightGridInput& input) {
  const auto& [c, to_u, to_v] = input.plane;
  const glm::dvec3 u = to_u - c, v = to_v - c, n = glm::cross(u, v);
  const glm::dvec3 from = glm::dvec3(input.light.center) - glm::dvec3(input.light.u) - glm::dvec3(input.light.v) - c;
  const double s = glm::dot(from, glm::cross(v, n)) / glm::dot(n, n),
               t = glm::dot(from, glm::cross(n, u)) / glm::dot(n, n);
  // The point is in the plane for all s and t; its rounding is that of visibility::PlanePoint.
  return {c + s * u + t * v, 0x1p-50 * (glm::length(c) + std::abs(s) * glm::length(u) + std::abs(t) * glm::length(v))};
}

/// Returns tiles of the light samples in cells, each within `deviation` of its stored place.
LightTiles tiles_of(const LightGrid& grid, const visibility::DeviceLight& light) {
  std::vector<glm::vec2> places;
  places.reserve(light.coordinates.size());
  for (const glm::vec2& st : light.coordinates) places.push_back(grid.first_cell + grid.half_cells * st);
  return make_light_tiles(places);
}

}  // namespace

LightGrid make_light_grid(const LightGridInput& input) {
  const glm::dvec3 u(input.light.u), v(input.light.v), n = glm::cross(u, v);
  const double squared = glm::dot(n, n);
  LightGrid grid;
  grid.center = input.light.center;
  if (input.is_rectangle) {
    // A multiple of a point and two more points, with a rounding each.
    grid.corner = 3.0 * input.plane[0] - input.plane[1] - input.plane[2];
    grid.corner_off = 0x1p-49 * static_cast<double>(input.reach);
  } else {
    const Corner corner = corner_around(input);
    grid.corner = corner.at;
    grid.corner_off = corner.off;
  }
  const bool in_rows = input.rows > 0;
  const auto some = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(input.points.size()))));
  grid.rows = in_rows ? input.rows : some;
  grid.columns = in_rows ? input.columns : some;
  grid.deviation = input.light.deviation;
  if (!input.window) {
    // Places of edges are relative to the frame's corner, but counting begins at the corner in the plane of the stored
    // points. They differ by the frame's rounding, whether or not light samples show it.
    const glm::dvec3 apart = glm::dvec3(input.light.center) - u - v - grid.corner;
    grid.deviation += 1.0001F * static_cast<float>(glm::length(apart));
  }
  grid.radius = (glm::length(input.light.u) + glm::length(input.light.v)) * 1.0001F + grid.deviation;
  grid.half_cells = 0.5F * glm::vec2(static_cast<float>(grid.columns), static_cast<float>(grid.rows));
  grid.first_cell = grid.half_cells - 0.5F;
  const std::array axes = axes_of(u, v, input.side, grid.half_cells);
  grid.across = glm::vec3(axes[0]);
  grid.along = glm::vec3(axes[1]);
  grid.axis = glm::vec3(axes[2]);
  grid.axes = axes_of(input.plane[1] - input.plane[0], input.plane[2] - input.plane[0], input.side, grid.half_cells);
  if (const auto& window = input.window) {
    grid.corner = window->corner;  // its error is (bound foot) of volumes/scatter/vectors/rows.cpp; reach includes the
                                   // skew
    grid.corner_off = 0x1p-49 * static_cast<double>(input.reach);
    grid.axes = axes_of(0.5 * window->u, 0.5 * window->v, input.side, grid.half_cells);
  }
  grid.axis_size = glm::abs(grid.axis);
  grid.per_length = std::max(glm::length(grid.across), glm::length(grid.along)) * 1.00001F;
  grid.skew = float_size1(u) * float_size1(v) / static_cast<float>(std::sqrt(squared)) * 1.00001F;
  if (input.window) grid.skew += static_cast<float>(input.window->skew);
  grid.reach = input.reach;
  grid.cut_reach = input.cut_reach;
  grid.side = input.side;
  grid.light = input.light_index;
  grid.sample_count = static_cast<std::uint32_t>(input.points.size());
  grid.corners = {-grid.half_cells, -grid.half_cells};
  for (const glm::vec3& point : input.points) grid.points.push_back(point * input.scale);
  if (!in_rows) {
    grid.tiles = tiles_of(grid, input.light);
    return grid;
  }
  grid.padded_rows = (input.rows + 15) / 16 * 16;
  for (std::uint32_t row = 0; row < grid.padded_rows; ++row) {
    grid.shift.push_back(row < input.rows ? shift_of(row, input.light.shift_step) : 0);
  }
  return grid;
}

namespace {

/// Returns the slopes by which the hull of view samples and a rectangle in the light's plane (`low`, `high`: in cells
/// from its middle) widens to the right, left, along and back, in cells for a unit of height.
template <typename At>
std::array<float, 4> slopes_of(const LightGrid& grid, std::span<const At> samples, const glm::vec2& low,
                               const glm::vec2& high) {
  std::array<float, 4> slopes;
  slopes.fill(-1e18F);
  for (const GridSample& at : samples) {
    const glm::vec2 from = at.foot - grid.first_cell;
    const float inverse = 1 / at.height;
    const std::array over{from.x - high.x, low.x - from.x, from.y - high.y, low.y - from.y};
    for (std::size_t i = 0; i < 4; ++i) slopes[i] = std::max(slopes[i], over[i] * inverse);
  }
  return slopes;
}

Shaft make_shaft(const LightGrid& grid, std::span<const GridSample> samples, const glm::vec2& low,
                 const glm::vec2& high) {
  const std::array<float, 4> slopes = slopes_of(grid, samples, low, high);
  float height = 0;
  for (const GridSample& at : samples) height = std::max(height, at.height);
  const float widest = std::max(grid.half_cells.x, grid.half_cells.y);
  const std::array beyond{high.x, -low.x, high.y, -low.y};
  Shaft shaft;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::vec3 side = (i < 2 ? grid.across : grid.along) * (i % 2 == 0 ? 1.0F : -1.0F);
    const glm::vec3 n = side - slopes[i] * grid.axis;
    const float size = float_size1(n) + float_size1(side);
    shaft.n[i] = n;
    shaft.size[i] = glm::abs(n);
    shaft.beyond[i] = glm::dot(n, grid.center) + beyond[i] +
                      64 * kRound * (2 * grid.reach * size + grid.skew * widest) + size * grid.deviation;
  }
  const float slack = 128 * kRound * grid.reach + grid.deviation, light = glm::dot(grid.axis, grid.center);
  shaft.highest = light + height + slack;
  shaft.lowest = light - slack;
  return shaft;
}

}  // namespace

Cluster make_cluster(const LightGrid& grid, std::span<const GridSample> samples) {
  glm::vec3 lower(samples.front().p), upper(lower);
  for (const GridSample& at : samples) {
    lower = glm::min(lower, at.p);
    upper = glm::max(upper, at.p);
  }
  Cluster cluster;
  const std::uint32_t plane = samples.front().plane;
  const bool one = std::all_of(samples.begin(), samples.end(), [&](const GridSample& at) { return at.plane == plane; });
  if (one) cluster.plane = plane;
  cluster.middle = 0.5F * lower + 0.5F * upper;
  cluster.half_size = glm::max(upper - cluster.middle, cluster.middle - lower) * (1 + 8 * kRound);
  cluster.whole = make_shaft(grid, samples, -grid.half_cells, grid.half_cells);
  cluster.corner = make_shaft(grid, samples, grid.corners.low, grid.corners.high);
  return cluster;
}

ClusterSample complete(const LightGrid& grid, const Cluster& cluster, const GridSample& placed) {
  ClusterSample at;
  static_cast<GridSample&>(at) = placed;
  at.local = at.p - cluster.middle;
  // Same order as dot() of find.cpp, without fused operations.
  const auto dot = [&](const glm::vec3& n) { return (at.local.x * n.x + at.local.y * n.y) + at.local.z * n.z; };
  at.in_grid = {dot(grid.across), dot(grid.along), dot(grid.axis)};
  at.far = glm::length(at.local) * 1.0001F;
  at.away = glm::length(at.p - grid.center) * 1.0001F;
  constexpr float kMore = 1.05F;  // allowance for second-order terms
  const float cells = 16 * kRound * grid.skew * (grid.half_cells.x + grid.half_cells.y);
  const float lengths = at.away / at.height;
  Placing& place = at.on_grid;
  place.foot = at.foot;
  place.height = at.height;
  place.per_ray = kMore * (8 * kRound * grid.per_length * at.height + cells);
  place.per_reach = 8 * kRound;
  place.per_foot = kMore * (kRound * (4 * lengths + 8) + grid.deviation / at.height);
  place.fixed = kMore * (kRound * grid.per_length * 4 * at.away + cells + grid.per_length * grid.deviation);
  // A direction is off by 8 ε of its length, also sideways. In the second term this is divided by the window's size in
  // cells; it is the larger term where the light is small for its height.
  const glm::vec2 off = glm::abs(at.foot - grid.first_cell), window = 2.0F * grid.half_cells + 2.0F;
  place.per_lift = 64 * kRound *
                   (1 + 0.125F * (std::max(off.x, off.y) + grid.per_length * at.height) / std::min(window.x, window.y));
  place.through_p = 64 * kRound;
  at.on_light = place;
  at.window = {glm::vec2(-0.5F), 2.0F * grid.half_cells - 0.5F};
  at.lean = (glm::vec2(-0.5F) - at.foot) / at.height;
  at.end = at.height;
  // Samples that floats leave open are decided in double at the stored corner, which is slightly off this frame's.
  at.per_lean = kRound * (8 * grid.per_length * (1 + lengths) + (16 + 8 * lengths) * glm::length(at.lean)) +
                kMore * (grid.per_length + glm::length(at.lean)) * grid.deviation / at.height;
  if (grid.cones) see_cone(grid, at);
  return at;
}

Hull hull_of(const LightGrid& grid, const Cluster& cluster, std::span<const ClusterSample> samples) {
  Hull hull;
  hull.slope = slopes_of(grid, samples, -grid.half_cells, grid.half_cells);
  hull.highest = -3e38F;
  for (const ClusterSample& at : samples) hull.highest = std::max(hull.highest, at.in_grid.z);
  const glm::vec3 to_middle = cluster.middle - grid.center;
  const float height = glm::dot(grid.axis, to_middle), widest = std::max(grid.half_cells.x, grid.half_cells.y);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::vec3& side = i < 2 ? grid.across : grid.along;
    const float sign = i % 2 == 0 ? 1.0F : -1.0F, half = i < 2 ? grid.half_cells.x : grid.half_cells.y;
    const float size = 2 * float_size1(side) + std::abs(hull.slope[i]) * float_size1(grid.axis);
    hull.beyond[i] = half - sign * glm::dot(side, to_middle) + hull.slope[i] * height +
                     96 * kRound * (2 * grid.reach * size + grid.skew * widest) + size * grid.deviation;
  }
  const float slack = 128 * kRound * grid.reach + grid.deviation;
  hull.highest += slack;
  hull.lowest = -height - slack;
  return hull;
}

}  // namespace penumbra::vectors
