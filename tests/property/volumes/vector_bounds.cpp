// How much of a bound of error is ever used on vector units: a search for the input that uses most of it. Exact values
// come from long double, 2⁻⁶⁴ beside bounds of 2⁻²⁴.

#include "engines/vectors/clusters.hpp"
#include "engines/vectors/light_grid.hpp"
#include "tests/agreement/most_used.hpp"
#include "tests/agreement/support.hpp"
#include "visibility/lights/device_light.hpp"
#include "visibility/tree/tree_texels.hpp"

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <random>

namespace penumbra::vectors {
namespace {

using Exact = glm::tvec3<long double>;

struct Use {
  double of_bound = 0, error = 0, bound = 0;
};

/// One view sample under a light, and a point whose place on the light is asked for.
class BoundX {
 public:
  explicit BoundX(const tests::Numbers& numbers) : numbers_(numbers) {}

  /// |X as computed − X| over its bound (docs/edge-scatter.md, "X, relative to a cluster"), the worse of two axes;
  /// nothing if the point is not well above p.
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
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const visibility::Light light =
        visibility::make_light(scene, 0, floats.origin, {64, 8, 8, visibility::SamplePattern::rows, 0});
    const float scale = visibility::device_scale(floats);
    const visibility::DeviceLight device_light = visibility::make_device_light(light, scale);
    const auto scaled = [&](const glm::vec3& x) { return glm::dvec3(x) * static_cast<double>(scale); };
    const LightGrid grid = make_light_grid({device_light,
                                            {scaled(light.center), scaled(light.center_u), scaled(light.center_v)},
                                            true,
                                            light.rows,
                                            light.columns,
                                            0,
                                            1,
                                            visibility::reach_of(floats, device_light, scale),
                                            0,
                                            scale,
                                            light.points});
    visibility::ViewSamples samples;
    samples.width = 2;
    samples.height = 1;
    for (int i = 0; i < 2; ++i) {
      const glm::dvec3 at = glm::dvec3(floats.positions[0]) + patch * (vector() + glm::dvec3(1, 0, -1));
      samples.triangle.push_back(0);
      samples.p.emplace_back(at);
      samples.n.emplace_back(0, 1, 0);
      samples.depth.push_back(1);
      samples.facing.push_back(1);
    }
    const std::vector<std::uint8_t> known(floats.triangles.size(), 1);
    const ViewInput view{floats, samples, device_light, grid, known, scale};
    std::array<GridSample, 2> view_samples;
    for (std::uint32_t i = 0; i < 2; ++i) {
      if (classify(view, i, view_samples[i]) != SampleClass::in_front) return {};
    }
    const Cluster cluster = make_cluster(grid, view_samples);
    const ClusterSample at = complete(grid, cluster, view_samples[0]);
    // A point over p, on the way to somewhere near the light.
    const glm::dvec3 target = scaled(light.center) + 2 * real() * (scaled(light.center_u) - scaled(light.center)) +
                              2 * real() * (scaled(light.center_v) - scaled(light.center));
    const glm::vec3 x(glm::mix(glm::dvec3(at.p), target, 0.95 * next()));
    return use_of(grid, cluster, at, x);
  }

 private:
  double next() { return numbers_.next(); }
  double real() { return numbers_.real(); }
  glm::dvec3 vector() { return numbers_.vector(); }

  static Use use_of(const LightGrid& grid, const Cluster& cluster, const ClusterSample& at, const glm::vec3& x) {
    // As the tables and Projection compute it: one order, nothing fused.
    const glm::vec3 from = x - cluster.middle;
    const auto dot = [&](const glm::vec3& n) { return (from.x * n.x + from.y * n.y) + from.z * n.z; };
    const float w = at.in_grid.z - dot(grid.axis), q = at.height / w;
    const float far = glm::length(from) * 1.0001F + at.far;
    if (!(w > 64 * kRound * far)) return {};
    const glm::vec2 place_on_light =
        at.foot + q * glm::vec2(dot(grid.across) - at.in_grid.x, dot(grid.along) - at.in_grid.y);
    // The light's plane and axes are those of the stored points (LightGrid::axes, exact up to 2⁻⁵³).
    const auto exact_dot = [](const glm::dvec3& n, const Exact& d) { return n.x * d.x + n.y * d.y + n.z * d.z; };
    const Exact p(at.p), way = Exact(x) - p, to_p = p - Exact(grid.corner);
    const long double height = exact_dot(grid.axes[2], to_p), over = -exact_dot(grid.axes[2], way);
    Use worst;
    for (int axis = 0; axis < 2; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      const long double place = exact_dot(grid.axes[i], to_p) + height / over * exact_dot(grid.axes[i], way) - 0.5L;
      const float from_foot = glm::length(place_on_light - at.foot);
      const double bound = far / w * (at.on_grid.per_way + at.on_grid.per_reach * from_foot) +
                           at.on_grid.per_foot * from_foot + at.on_grid.fixed;
      const auto error = static_cast<double>(std::abs(static_cast<long double>(place_on_light[axis]) - place));
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
  EXPECT_LT(most.of_bound, 1);
  EXPECT_GT(most.of_bound, 0.02) << "a bound that is never used is no bound of this error";
}

}  // namespace
}  // namespace penumbra::vectors
