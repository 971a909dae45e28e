// Edges seen at the corner of a light's window by view samples close together: whoever counts what hides that corner in
// two ways, by floats at where they put it and in double at where it is, must not take the one for the other.

#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/support.hpp"
#include "tests/agreement/volumes/exact_rows.hpp"
#include "volumes/edges/light_window.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>
#include <random>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

class Aim {
 public:
  explicit Aim(std::uint32_t seed) : random_(seed) {}
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double power(double low, double high) { return std::pow(10.0, real(low, high)); }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 d(real(-1, 1), real(-1, 1), real(-1, 1));
      if (glm::length(d) > 0.1 && glm::length(d) < 1) return glm::normalize(d);
    }
  }
  glm::dvec3 across(const glm::dvec3& n) { return glm::normalize(glm::cross(n, direction())); }

 private:
  std::mt19937_64 random_;
};

/// A polygon light, one triangle with an edge in front of its window's corner as p sees it, and 64 view samples around
/// p on a floor that casts no shadow.
struct AtTheCorner {
  SceneFloats floats;
  Light light;
  ViewSamples samples;

  /// `inside`: the edge is one between two triangles that together hide all around.
  AtTheCorner(std::uint32_t seed, bool inside) {
    Aim aim(seed);
    const double size = aim.power(-4, -1.5), height = size * aim.power(-0.5, 1);
    const glm::dvec3 center(aim.real(-0.9, 0.9), aim.real(-0.9, 0.9), aim.real(-0.9, 0.9));
    const glm::dvec3 n = aim.direction(), u = aim.across(n), v = glm::cross(n, u);
    scenes::Polygon polygon;
    const int corners = 3 + static_cast<int>(seed % 4);
    for (int i = 0; i < corners; ++i) {
      const double angle = (i + aim.real(0, 0.8)) * 2 * std::numbers::pi / corners;
      polygon.vertices.push_back(center + size * (std::cos(angle) * u + std::sin(angle) * v));
    }
    scenes::Scene scene;
    scenes::Object& anchor =
        tests::add_object(scene, "anchor", {{glm::dvec3(-1), glm::dvec3(1), glm::dvec3(1, -1, 1)}});
    anchor.casts_shadow = anchor.receives_shadow = false;
    scene.lights.push_back(tests::ceiling_light(1, 1));
    scene.lights[0].shape = polygon;
    scene.lights[0].two_sided = true;
    const glm::dvec3 p = center + height * n + 0.5 * size * (aim.real(-1, 1) * u + aim.real(-1, 1) * v);
    look(scene);
    const glm::dvec3 corner = axes_of(light, window_of(light)).corner + floats.origin,
                     along = glm::normalize(corner - p);
    const glm::dvec3 edge = aim.across(along), aside = glm::cross(along, edge);
    const glm::dvec3 x = p + aim.real(0.2, 0.9) * (corner - p) + 5e-8 * aim.real(-1, 1) * aside;
    const double width = size * aim.power(-1, 0.7);
    const glm::dvec3 from = x - width * aim.real(0.1, 1) * edge, to = x + width * aim.real(0.1, 1) * edge;
    const glm::dvec3 beside = (seed % 2 == 0 ? width : -width) * aside;
    std::vector<tests::Corners> occluder{{from, to, x + beside}};
    if (inside) occluder.push_back({to, from, x - beside});
    tests::add_object(scene, "occluder", occluder);
    const glm::dvec3 up = glm::normalize(n + 0.2 * aim.direction()), a = aim.across(up), b = glm::cross(up, a);
    const double floor = 4 * size;
    tests::add_object(scene, "floor", {{p - floor * a - floor * b, p + floor * a - floor * b, p + floor * b}})
        .casts_shadow = false;
    look(scene);
    const auto carrier = static_cast<std::int32_t>(floats.triangles.size() - 1);
    const auto [c0, c1, c2] = floats.corners(static_cast<std::uint32_t>(carrier));
    const glm::dvec3 normal = glm::cross(glm::dvec3(c1) - glm::dvec3(c0), glm::dvec3(c2) - glm::dvec3(c0));
    const std::int8_t facing = glm::dot(normal, center - p) > 0 ? 1 : -1;
    const double spread = aim.power(-8, -6.5);
    samples.width = samples.height = 8;
    for (int i = 0; i < 64; ++i) {
      samples.triangle.push_back(carrier);
      samples.p.emplace_back(p + spread * (aim.real(-1, 1) * a + aim.real(-1, 1) * b) - floats.origin);
      samples.n.emplace_back(static_cast<double>(facing) * glm::normalize(normal));
      samples.depth.push_back(1);
      samples.facing.push_back(facing);
    }
  }

 private:
  void look(const scenes::Scene& scene) {
    floats = visibility::make_scene_floats(scene);
    light = visibility::make_light(scene, 0, floats.origin, {256, 0, 0, visibility::SamplePattern::rows, 3});
  }
};

class WindowCorners : public tests::DeviceTest {};

TEST_F(WindowCorners, AreWhereAreasCountFrom) {
  const auto exact = reference::make_exact({});
  const auto areas = make_edge_scatter(device(), {{"engine", "native"}, {"rows", "exact"}});
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const AtTheCorner scene(seed, false);
    const tests::Masks truth = tests::run(*exact, scene.floats, scene.light, scene.samples),
                       found = tests::run(*areas, scene.floats, scene.light, scene.samples);
    for (std::size_t i = 0; i < scene.samples.size(); ++i)
      ASSERT_NEAR(found.visibility[i], truth.visibility[i], tests::kExactRowsTolerance)
          << "seed " << seed << " pixel " << i;
  }
}

TEST_F(WindowCorners, AreWhereMasksCountFrom) {
  for (const tests::MaskMethod& one : {tests::kNativeEdgeScatter, tests::kNativeDepthComplexity}) {
    const auto method = one.make(device(), {});
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
      const AtTheCorner scene(seed, true);
      EXPECT_TRUE(tests::equals_truth(scene.floats, scene.light, scene.samples,
                                      tests::run(*method, scene.floats, scene.light, scene.samples)))
          << one.name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace penumbra::volumes
