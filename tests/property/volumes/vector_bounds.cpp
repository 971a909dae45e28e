// SPDX-License-Identifier: Apache-2.0
// Measures how much of a bound of error is ever used on vector units: searches for the input that uses most of it.
// Exact values come from long double, whose error of 2⁻⁶⁴ is small compared with bounds of 2⁻²⁴.

#include "tests/agreement/crossings.hpp"
#include "tests/agreement/most_used.hpp"
#include "tests/property/volumes/under_a_light.hpp"
#include "volumes/scatter/methods.hpp"

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

namespace penumbra::vectors {
namespace {

using Exact = glm::tvec3<long double>;

struct Use {
  double of_bound = 0, error = 0, bound = 0;
};

/// Computes the place at which a point appears as the tables and Projection do: in the same order, without fused
/// operations.
struct Appears {
  glm::vec2 at{0};
  float bound = 0;  ///< of either coordinate's error; 0 if the point is not clearly above p
};
Appears appears(const LightGrid& grid, const Cluster& cluster, const ClusterSample& at, const glm::vec3& x) {
  const glm::vec3 from = x - cluster.middle;
  const auto dot = [&](const glm::vec3& n) { return (from.x * n.x + from.y * n.y) + from.z * n.z; };
  const float w = at.in_grid.z - dot(grid.axis), q = at.height / w;
  const float far = glm::length(from) * 1.0001F + at.far;
  if (!(w > 64 * kRound * far)) return {};
  const glm::vec2 place = at.foot + q * glm::vec2(dot(grid.across) - at.in_grid.x, dot(grid.along) - at.in_grid.y);
  const float from_foot = glm::length(place - at.foot);
  return {place, far / w * (at.on_grid.per_ray + at.on_grid.per_reach * from_foot) + at.on_grid.per_foot * from_foot +
                     at.on_grid.fixed};
}

/// One view sample under a light, and a point whose place on the light is computed.
class BoundX {
 public:
  explicit BoundX(const tests::Numbers& numbers) : numbers_(numbers) {}

  /// Returns |computed X − X| over its bound (docs/edge-scatter.md, "X, relative to a cluster"), the worse of two axes;
  /// an empty Use if the point is not clearly above p.
  Use operator()() {
    const double away = std::exp2(6 * next()), size = std::exp2(-6 * next()), patch = std::exp2(-12 * next());
    scenes::Scene scene;
    const glm::dvec3 offset = away * vector();
    tests::add_object(scene, "floor", tests::quad(offset, {1, 0.2 * real(), 0}, {0, 0.3 * real(), -1}));
    tests::add_object(scene, "anchor", {{glm::dvec3(-80), glm::dvec3(80, 80, -80), glm::dvec3(80)}}).casts_shadow =
        false;
    scene.lights.push_back(tests::rectangle_light(offset + glm::dvec3(3 * real(), 1 + 4 * next(), 3 * real()),
                                                  size * glm::dvec3(1, 0.3 * real(), 0.3 * real()),
                                                  size * glm::dvec3(0.5 * real(), 0.3 * real(), 1)));
    tests::UnderALight under(scene);
    const auto near = [&] {
      return glm::vec3(glm::dvec3(under.floats.positions[0]) + patch * (vector() + glm::dvec3(1, 0, -1)));
    };
    const glm::vec3 one = near(), other = near();
    const auto placed = under.place({one, other});
    if (!placed) return {};
    const Cluster cluster = make_cluster(under.grid, *placed);
    const ClusterSample at = complete(under.grid, cluster, placed->front());
    // A point above p, on the segment to a place near the light.
    const glm::dvec3 center = under.scaled(under.light.center);
    const glm::dvec3 target = center + 2 * real() * (under.scaled(under.light.center_u) - center) +
                              2 * real() * (under.scaled(under.light.center_v) - center);
    return use_of(under.grid, cluster, at, glm::vec3(glm::mix(glm::dvec3(at.p), target, 0.95 * next())));
  }

 private:
  double next() { return numbers_.next(); }
  double real() { return numbers_.real(); }
  glm::dvec3 vector() { return numbers_.vector(); }

  static Use use_of(const LightGrid& grid, const Cluster& cluster, const ClusterSample& at, const glm::vec3& x) {
    const Appears computed = appears(grid, cluster, at, x);
    if (computed.bound == 0) return {};
    // The light's plane and axes are those of the stored points (LightGrid::axes, exact up to 2⁻⁵³).
    const auto exact_dot = [](const glm::dvec3& n, const Exact& d) { return n.x * d.x + n.y * d.y + n.z * d.z; };
    const Exact p(at.p), direction = Exact(x) - p, to_p = p - Exact(grid.corner);
    const long double height = exact_dot(grid.axes[2], to_p), over = -exact_dot(grid.axes[2], direction);
    Use worst;
    for (int axis = 0; axis < 2; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      const long double place =
          exact_dot(grid.axes[i], to_p) + height / over * exact_dot(grid.axes[i], direction) - 0.5L;
      const auto error = static_cast<double>(std::abs(static_cast<long double>(computed.at[axis]) - place));
      const auto bound = static_cast<double>(computed.bound);
      if (error / bound > worst.of_bound) worst = {error / bound, error, bound};
    }
    return worst;
  }

  tests::Numbers numbers_;
};

TEST(VectorBounds, PlacesOfPointsOnTheLight) {
  std::mt19937 random(1);
  const Use most =
      BoundX(tests::most_used(random, 20000, [](const tests::Numbers& x) { return BoundX(x)().of_bound; }))();
  fmt::print("X: {:.1f} % of the bound used (off by {:.2e} cells, allowed {:.2e})\n", 100 * most.of_bound, most.error,
             most.bound);
  RecordProperty("percent_of_bound_X", fmt::format("{:.1f}", 100 * most.of_bound));
  EXPECT_LT(most.of_bound, 1);
  EXPECT_GT(most.of_bound, 0.02) << "hardly any of the bound is used: the search measures another error";
}

/// One view sample under a light, and a triangle with an edge that passes one of the light samples within rounding.
class AimedCrossing {
 public:
  explicit AimedCrossing(tests::Numbers numbers) {
    const double away = std::exp2(3 * numbers.next()), size = std::exp2(-5 * numbers.next());
    const glm::dvec3 offset = away * numbers.vector(),
                     over(3 * numbers.real(), 1 + 4 * numbers.next(), 3 * numbers.real());
    tests::add_object(scene_, "floor",
                      {{offset + glm::dvec3(-1, 0, 1), offset + glm::dvec3(1, 0.3, 0), offset + glm::dvec3(0, 0, -1)}});
    tests::add_object(scene_, "anchor", {{glm::dvec3(-32), glm::dvec3(32, 32, -32), glm::dvec3(32)}}).casts_shadow =
        false;
    scene_.lights.push_back(tests::rectangle_light(offset + over,
                                                   size * glm::dvec3(1, 0.3 * numbers.real(), 0.3 * numbers.real()),
                                                   size * glm::dvec3(0.5 * numbers.real(), 0.3 * numbers.real(), 1)));
    p_ = glm::vec3(offset + glm::dvec3(0, 0.1, 0));
    // The light samples are those of the scene without the triangle, as no part of it is outside the anchor.
    const tests::UnderALight without(scene_);
    sample_ = std::min(static_cast<std::uint32_t>(64 * numbers.next()), 63U);
    const std::array triangle =
        tests::triangle_at(glm::dvec3(p_), glm::dvec3(without.light.points[sample_]), 2 * size, numbers);
    edge_ = {glm::vec3(triangle[0]), glm::vec3(triangle[1])};
    tests::add_object(scene_, "caster", {triangle});
    under_.emplace(scene_);
    is_placed_ = under_->floats.origin == glm::dvec3(0) && under_->place({p_}).has_value();
  }

  /// Returns the distance from the light sample to the crossing; nothing if the edge is not clearly above p.
  [[nodiscard]] tests::Rounded crossing() {
    if (!is_placed_) return {};
    const std::vector<GridSample> placed = *under_->place({p_});
    const LightGrid& grid = under_->grid;
    const Cluster cluster = make_cluster(grid, placed);
    const ClusterSample at = complete(grid, cluster, placed[0]);
    const std::array ends{appears(grid, cluster, at, edge_[0] * under_->scale),
                          appears(grid, cluster, at, edge_[1] * under_->scale)};
    if (ends[0].bound == 0 || ends[1].bound == 0) return {};
    const visibility::Light& light = under_->light;
    const std::uint32_t row = sample_ / light.columns, column = sample_ % light.columns;
    const glm::dvec3 step =
        (glm::dvec3(light.center_u) - glm::dvec3(light.center)) * (2.0 / static_cast<double>(light.columns));
    return tests::crossing_as_rounded({{ends[0].at, ends[1].at}, {ends[0].bound, ends[1].bound}}, grid.half_cells,
                                      {static_cast<float>(row), static_cast<float>(column), grid.shift[row]},
                                      tests::exact_crossing(p_, light.points[sample_], edge_, step));
  }

  [[nodiscard]] const tests::UnderALight& under() const { return *under_; }

 private:
  scenes::Scene scene_;
  glm::vec3 p_{0};
  std::uint32_t sample_ = 0;
  std::array<glm::vec3, 2> edge_{};
  std::optional<tests::UnderALight> under_;
  bool is_placed_ = false;
};

class VectorCrossings : public tests::DeviceTest {};

/// Tests every bit where the computed crossing is on the other side of a light sample than the exact one, by as much of
/// the bound as the search finds.
TEST_F(VectorCrossings, OnTheWrongSideOfALightSample) {
  const auto method = volumes::make_edge_scatter(device(), {{"engine", "native"}});
  double used = 0;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    std::mt19937 random(seed);
    AimedCrossing aimed(tests::most_used(
        random, 1500, [](const tests::Numbers& numbers) { return AimedCrossing(numbers).crossing().far_wrong(); }));
    used = std::max(used, aimed.crossing().wrong());
    const tests::UnderALight& under = aimed.under();
    const tests::Masks masks = tests::run(*method, under.floats, under.light, under.samples);
    EXPECT_TRUE(equals_truth(under.floats, under.light, under.samples, masks)) << "seed " << seed;
  }
  fmt::print("crossings: {:.1f} % of the bound used\n", 100 * used);
  RecordProperty("percent_of_bound_crossing", fmt::format("{:.1f}", 100 * used));
  EXPECT_LT(used, 1);
  EXPECT_GT(used, 0.02) << "planted_faults cuts the bound to less than this share, which would not be noticed";
}

}  // namespace
}  // namespace penumbra::vectors
