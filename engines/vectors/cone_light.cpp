// SPDX-License-Identifier: Apache-2.0
// Spheres and suns on the vector engine: each view sample's cone, its error bounds, and a rectangle behind the cones of
// neighbouring view samples. See docs/edge-scatter.md, "Spheres and suns".

#include "engines/vectors/cone_light.hpp"

#include "base/error.hpp"
#include "base/size1.hpp"
#include "engines/vectors/disk_plane.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/pair_truth.hpp"
#include "visibility/receivers.hpp"
#include "visibility/tree/tree_texels.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace penumbra::vectors {
namespace {

/// Smallest tangent of half a sun's angle: the light points of a thinner sun would differ by no more than float32's
/// rounding.
constexpr double kThinnest = 0x1p-12;
constexpr std::uint32_t kCells = 16;  ///< cells on a side, if light samples are not used
constexpr double kFlattest = 0x1p8;   ///< tangent of half a cone's angle; for wider cones exact predicates decide
constexpr double kRoundingOf = 0x1p-24;

double largest(const glm::dvec3& x) {
  return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
}

/// Returns directions to the corners of the square around a cone.
std::array<glm::dvec3, 4> corners_of(const LightCone& cone) {
  const auto& [m, u, v] = cone;
  return {m - u - v, m + u - v, m + u + v, m - u + v};
}

/// A rectangle orthogonal to an axis.
struct Rectangle {
  glm::dvec2 low{INFINITY}, high{-INFINITY};

  void add(const glm::dvec2& x) {
    low = glm::min(low, x);
    high = glm::max(high, x);
  }
};

/// Returns whether a triangle may meet the box of half-sizes `half` around `middle`; false if a side of the box or the
/// triangle's plane certainly separates them. The test is needed because a leaf of the tree, or a sphere, around a
/// large triangle reaches far beyond it.
bool may_meet_box(const std::array<glm::vec3, 3>& corners, const glm::vec3& middle, const glm::vec3& half) {
  const glm::dvec3 from = middle, size = half;
  const glm::dvec3 a = glm::dvec3(corners[0]) - from, b = glm::dvec3(corners[1]) - from,
                   c = glm::dvec3(corners[2]) - from;
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    if (std::min({a[axis], b[axis], c[axis]}) > size[axis] || std::max({a[axis], b[axis], c[axis]}) < -size[axis])
      return false;
  }
  const glm::dvec3 to_b = b - a, to_c = c - a, normal = glm::cross(to_b, to_c);
  // Differences, products and sums err by a few roundings of these magnitudes, 2⁻⁵³ each.
  const double error = 0x1p-48 * size1(to_b) * size1(to_c) * (size1(a) + size1(size));
  return !(std::abs(glm::dot(normal, a)) > glm::dot(glm::abs(normal), size) + error);
}

}  // namespace

ConeLight::ConeLight(const visibility::Light& light, const visibility::SceneFloats& scene,
                     const visibility::TriangleTree& tree, const ConeOptions& options)
    : light_(light),
      light_samples_(options.light_samples),
      cuts_casters_(options.cuts_casters),
      scale_(static_cast<double>(visibility::device_scale(scene))) {
  for (int i = 0; i < 3; ++i) reach_ = std::max({reach_, std::abs(scene.lower[i]), std::abs(scene.upper[i])});
  reach_ *= static_cast<float>(scale_);
  if (light.sun) {
    const bool as_it_is = !light_samples_ && light.sun->tangent > 0;
    tangent_ = as_it_is ? light.sun->tangent : std::max(light.sun->tangent, kThinnest);
    const double farthest = 1 + 2 * tangent_;
    // Error of a light point: the middle and two axes are rounded to float, and are then not exactly orthogonal.
    deviation_ = 8 * kRoundingOf * farthest;
    // Heights are along −center: the grid is slightly below the scene's box, so that no view sample is close to it.
    const glm::dvec3 toward = glm::normalize(glm::dvec3(light.center));
    const glm::dvec3 low = scale_ * glm::dvec3(scene.lower), high = scale_ * glm::dvec3(scene.upper);
    beyond_ = -(glm::dot(glm::max(toward, 0.0), high) + glm::dot(glm::min(toward, 0.0), low)) -
              0.0625 * glm::length(high - low) - 0x1p-10 * static_cast<double>(reach_);
    return;
  }
  const double r = light.radius, reach = largest(glm::dvec3(light.center)) + r;
  visibility::check_size(light, visibility::box_of_sphere(light, static_cast<float>(scale_)), options.method);
  deviation_ = scale_ * (2 * kRoundingOf * reach + 0x1p-147);  // at most √3 / 2 units in the last place
  reach_ = std::max(reach_, static_cast<float>(scale_ * reach * 1.0001));
  const glm::vec3 box(static_cast<float>(2.25 * r) + 0x1p-12F * reach_ / static_cast<float>(scale_));
  tree.for_each_near(light.center - box, light.center + box, [&](std::uint32_t triangle) {
    if (scene.casts_shadow[triangle] == 0 || scene.emits[triangle] == light.index) return;
    const auto corners = scene.corners(triangle);
    if (!may_meet_box(corners, light.center, box)) return;
    NearCaster& caster = near_.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)  // scaled as edges are
      caster.corners[i] = glm::dvec3(corners[i] * static_cast<float>(scale_));
    std::ranges::sort(caster.corners, comes_first);
    caster.middle = (caster.corners[0] + caster.corners[1] + caster.corners[2]) / 3.0;
    for (const glm::dvec3& corner : caster.corners)
      caster.radius = std::max(caster.radius, 1.001 * glm::length(corner - caster.middle));
    caster.triangle = triangle;
    caster.plane = scene.plane[triangle];
  });
  if (cuts_casters_) near_side_by_side_ = side_by_side(near_);
}

LightGrid ConeLight::make_grid() const {
  LightGrid grid;
  grid.sample_count = light_.sample_count();
  grid.rows = grid.columns =
      light_samples_ ? static_cast<std::uint32_t>(std::lround(std::sqrt(grid.sample_count))) : kCells;
  grid.half_cells = 0.5F * glm::vec2(static_cast<float>(grid.columns), static_cast<float>(grid.rows));
  grid.first_cell = grid.half_cells - 0.5F;
  grid.light = static_cast<std::uint32_t>(light_.index);
  std::vector<glm::vec2> places;
  const double share = light_.sun ? light_.sun->tangent / tangent_ : 1;
  for (const glm::dvec2& st : light_.coordinates)
    places.emplace_back(glm::dvec2(grid.first_cell) + share * glm::dvec2(grid.half_cells) * st);
  grid.tiles = make_light_tiles(places);
  grid.reach = reach_;
  grid.cones = LightGrid::Cones{};  // clang 14 cannot emplace() a type whose enclosing class is incomplete
  grid.cones->end = !light_.sun;
  grid.cones->deviation = static_cast<float>(deviation_ * 1.0001);
  grid.cones->reach = static_cast<double>(reach_);
  return grid;
}

SampleClass ConeLight::classify(const ViewInput& view, std::uint32_t pixel, GridSample& at, LightCone& cone) const {
  if (!visibility::is_receiver(view.scene, light_, view.samples, pixel)) return SampleClass::all_visible;
  const auto triangle = static_cast<std::uint32_t>(view.samples.triangle[pixel]);
  const glm::vec3& p = view.samples.p[pixel];
  at.p = p * view.scale;
  at.pixel = pixel;
  at.plane = view.scene.plane[triangle];
  if (light_.sun) {
    cone = {glm::dvec3(light_.center), tangent_ * glm::dvec3(light_.sun->axis_u),
            tangent_ * glm::dvec3(light_.sun->axis_v)};
    if (tangent_ >= kFlattest) return SampleClass::open;
  } else {
    if (!visibility::in_front_of_light(light_, p)) return SampleClass::other_side;
    const visibility::LightFrame seen = visibility::light_frame_from(light_, p);
    cone = {scale_ * (seen.center - glm::dvec3(p)), scale_ * seen.u, scale_ * seen.v};
    if (!(glm::length(cone.u) > 0 && kFlattest * glm::length(cone.middle) > glm::length(cone.u)))
      return SampleClass::open;
  }
  // Error of the horizon: (bound horizon) of docs/edge-scatter.md.
  const glm::dvec3 n = view.normals.is_known(triangle) ? glm::dvec3(view.samples.n[pixel]) : glm::dvec3(0);
  const glm::dvec3 above(glm::dot(n, cone.u), glm::dot(n, cone.v), glm::dot(n, cone.middle));
  const double from_p = light_.sun ? 0 : size1(glm::dvec3(at.p));
  const double error = 16 * kRoundingOf * (size1(cone.middle) + size1(cone.u) + size1(cone.v) + from_p) + deviation_;
  // Reach of the square for a dome's face, else of the disk in it.
  const double reach = light_.dome ? std::abs(above.x) + std::abs(above.y) : std::hypot(above.x, above.y);
  const double span = reach * (1 + 0x1p-20);
  at.above = glm::vec3(above);
  at.above_error = static_cast<float>(error);
  if (above.z + span < -error) return SampleClass::none_visible;
  if (!near_.empty() && touches(*view.grid.cones, cone, glm::dvec3(at.p))) return SampleClass::open;
  // For areas, a face of half a dome may also end at its middle.
  at.straddles = above.z - span <= error || (light_.dome && light_.dome->half && !light_samples_);
  return SampleClass::in_front;
}

/// Returns whether a caster may meet the square around the disk, or come so close to the disk's plane there that float
/// arithmetic does not determine its side. Also true if places in the plane have errors of half a square or more.
/// (bound ends of docs/edge-scatter.md)
bool ConeLight::touches(const LightGrid::Cones& cones, const LightCone& cone, const glm::dvec3& p) const {
  const double around = around_disk(cones, cone);
  if (!(around < 1.5)) return true;
  if (cuts_casters_) return false;
  const DiskPlane plane(cone, p);
  const double slab = slab_of(cones);
  return std::ranges::any_of(near_, [&](const NearCaster& caster) { return meets_disk(plane, caster, slab, around); });
}

bool ConeLight::turn(LightGrid& grid, std::span<GridSample> samples) const {
  const std::span<const LightCone> cones = grid.cones->of;
  glm::dvec3 toward{0};
  for (const GridSample& at : samples) toward += glm::normalize(cones[at.cone].middle);
  const glm::dvec3 axis = -glm::normalize(toward);
  const glm::dvec3 first_u = cones[samples.front().cone].u;
  const glm::dvec3 x_axis = glm::normalize(first_u - glm::dot(first_u, axis) * axis), y_axis = glm::cross(axis, x_axis);
  const double flattest = samples.size() == 1 ? 0x1p-12 : 0x1p-4;
  double lowest = light_.sun ? beyond_ : INFINITY, highest = -INFINITY;
  for (const GridSample& at : samples) {
    for (const glm::dvec3& direction : corners_of(cones[at.cone])) {
      const double down = glm::dot(axis, direction);
      if (!(-down > flattest * glm::length(direction))) return false;
      if (light_.sun) continue;
      const double level = glm::dot(axis, glm::dvec3(at.p)) + down;
      lowest = std::min(lowest, level);
      highest = std::max(highest, level);
    }
  }
  Rectangle all, corners;
  for (const GridSample& at : samples) {
    const glm::dvec3 p(at.p);
    const double height = glm::dot(axis, p) - lowest;
    const std::array directions = corners_of(cones[at.cone]);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const glm::dvec3 there = p + height / -glm::dot(axis, directions[i]) * directions[i];
      const glm::dvec2 place(glm::dot(x_axis, there), glm::dot(y_axis, there));
      all.add(place);
      if (i == 0) corners.add(place);
    }
  }
  const glm::dvec2 middle = 0.5 * (all.low + all.high);
  const glm::dvec2 half = 0.5001 * (all.high - all.low) + 0x1p-20 * static_cast<double>(reach_);
  const glm::dvec2 per_length = glm::dvec2(grid.half_cells) / half;
  const glm::dvec3 center = middle.x * x_axis + middle.y * y_axis + lowest * axis;
  grid.center = glm::vec3(center);
  grid.axis = glm::vec3(axis);
  grid.axis_size = glm::abs(grid.axis);
  grid.across = glm::vec3(per_length.x * x_axis);
  grid.along = glm::vec3(per_length.y * y_axis);
  grid.per_length = static_cast<float>(std::max(per_length.x, per_length.y) * 1.00001);
  grid.skew = 1.0001F;
  grid.reach = std::max(reach_, static_cast<float>(largest(center) + half.x + half.y));
  grid.deviation = 0x1p-21F * grid.reach;
  const glm::vec2 around(0x1p-10F);
  grid.corners = {glm::vec2((corners.low - middle) * per_length) - around,
                  glm::vec2((corners.high - middle) * per_length) + around};
  grid.cones->lowest_end =
      light_.sun ? -1e30F : static_cast<float>(highest - lowest) + 128 * kRound * grid.reach + grid.deviation;
  for (GridSample& at : samples) {
    const glm::dvec3 p(at.p);
    at.height = static_cast<float>(glm::dot(axis, p) - lowest);
    at.foot = grid.first_cell + glm::vec2((glm::dvec2(glm::dot(x_axis, p), glm::dot(y_axis, p)) - middle) * per_length);
  }
  return true;
}

Cluster everything(std::span<const GridSample> samples) {
  glm::vec3 lower(samples.front().p), upper(lower);
  for (const GridSample& at : samples) {
    lower = glm::min(lower, at.p);
    upper = glm::max(upper, at.p);
  }
  Cluster cluster;
  cluster.middle = 0.5F * lower + 0.5F * upper;
  cluster.half_size = glm::max(upper - cluster.middle, cluster.middle - lower) * (1 + 8 * kRound);
  cluster.whole.lowest = -1e30F;
  cluster.whole.highest = 1e30F;
  cluster.whole.beyond.fill(1);
  cluster.corner = cluster.whole;
  return cluster;
}

void see_cone(const LightGrid& grid, ClusterSample& at) {
  const LightCone& cone = grid.cones->of[at.cone];
  const double height = glm::length(cone.middle), radius = glm::length(cone.u);
  const glm::dvec3 across(grid.across), along(grid.along), axis(grid.axis);
  // direction_of maps the grid's coordinates to a direction; `turn` maps this on to the light's coordinates.
  const glm::dmat3 direction_of(across / glm::dot(across, across), along / glm::dot(along, along), -axis);
  const glm::dvec2 half(grid.half_cells);
  const glm::dvec3 x = half.x / glm::dot(cone.u, cone.u) * cone.u, y = half.y / glm::dot(cone.v, cone.v) * cone.v,
                   w = cone.middle / height;
  for (int i = 0; i < 3; ++i)
    at.turn[i] = glm::vec3(glm::dot(x, direction_of[i]), glm::dot(y, direction_of[i]), glm::dot(w, direction_of[i]));

  constexpr double kMore = 1.05;  // allowance for second-order terms
  const double cells = std::max(half.x, half.y), deviation = static_cast<double>(grid.cones->deviation);
  const double per_tangent = cells * height / radius;
  const auto rounded = [](double bound) { return static_cast<float>(kMore * bound); };
  Placing& place = at.on_light;
  place.foot = grid.first_cell;
  place.height = static_cast<float>(height);
  place.per_ray = rounded(24 * kRoundingOf * per_tangent);
  place.per_reach = rounded(24 * kRoundingOf);
  place.per_foot = rounded(12 * kRoundingOf + deviation / height);
  place.fixed = rounded(16 * kRoundingOf * (half.x + half.y) + cells / radius * deviation);
  place.per_lift = rounded(kRoundingOf * (128 + 64 * per_tangent / (2 * std::min(half.x, half.y) + 2)));
  place.through_p = 192 * kRound;

  Rectangle window;
  const auto place_of = [&](const glm::dvec3& direction) {
    return glm::dvec2(glm::dot(across, direction), glm::dot(along, direction)) / -glm::dot(axis, direction);
  };
  for (const glm::dvec3& direction : corners_of(cone)) window.add(place_of(direction));
  const auto over = static_cast<double>(at.height);
  const glm::vec2 around(0x1p-10F);
  at.window = {at.foot + glm::vec2(over * window.low) - around, at.foot + glm::vec2(over * window.high) + around};
  at.lean = glm::vec2(place_of(cone.corner()));
  at.end = grid.cones->end ? static_cast<float>(-glm::dot(axis, cone.corner())) : 1e30F;
  at.per_lean = kRound * (16 * grid.per_length + 24 * glm::length(at.lean));
  const LightGrid::Cones& cones = *grid.cones;
  at.meets_end = cones.near != nullptr &&
                 any_may_meet(DiskPlane(cone, glm::dvec3(at.p)), *cones.near, slab_of(cones), around_disk(cones, cone));
}

}  // namespace penumbra::vectors
