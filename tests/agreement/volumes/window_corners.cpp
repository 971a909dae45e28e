// Edges seen at the corner of a light's window by view samples close together: whoever counts what hides that corner in
// two ways, by floats at where they put it and in double at where it is, must not take the one for the other.

#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/volumes/aimed_scene.hpp"
#include "tests/agreement/volumes/exact_rows.hpp"
#include "volumes/edges/light_window.hpp"

#include <numbers>

namespace penumbra::volumes {
namespace {

/// A polygon light, and one triangle with an edge in front of its window's corner as p sees it. `inside`: the edge is
/// one between two triangles that together hide all around.
tests::OneLightScene at_the_corner(std::uint32_t seed, bool inside) {
  tests::Draws aim(seed);
  const double size = aim.power(-4, -1.5), height = size * aim.power(-0.5, 1);
  const glm::dvec3 center(aim.real(-0.9, 0.9), aim.real(-0.9, 0.9), aim.real(-0.9, 0.9));
  const glm::dvec3 n = aim.direction(), u = aim.across(n), v = glm::cross(n, u);
  scenes::Polygon polygon;
  const int corners = 3 + static_cast<int>(seed % 4);
  for (int i = 0; i < corners; ++i) {
    const double angle = (i + aim.real(0, 0.8)) * 2 * std::numbers::pi / corners;
    polygon.vertices.push_back(center + size * (std::cos(angle) * u + std::sin(angle) * v));
  }
  tests::OneLightScene scene(polygon, {256, 0, 0, visibility::SamplePattern::rows, 3});
  const glm::dvec3 p = center + height * n + 0.5 * size * (aim.real(-1, 1) * u + aim.real(-1, 1) * v);
  const glm::dvec3 corner = axes_of(scene.light, window_of(scene.light)).corner + scene.floats.origin,
                   along = glm::normalize(corner - p);
  const glm::dvec3 edge = aim.across(along), aside = glm::cross(along, edge);
  const glm::dvec3 x = p + aim.real(0.2, 0.9) * (corner - p) + 5e-8 * aim.real(-1, 1) * aside;
  const double width = size * aim.power(-1, 0.7);
  const glm::dvec3 from = x - width * aim.real(0.1, 1) * edge, to = x + width * aim.real(0.1, 1) * edge;
  const glm::dvec3 beside = (seed % 2 == 0 ? width : -width) * aside;
  std::vector<tests::Corners> occluder{{from, to, x + beside}};
  if (inside) occluder.push_back({to, from, x - beside});
  scene.add_occluder(occluder);
  const glm::dvec3 up = glm::normalize(n + 0.2 * aim.direction());
  scene.look_from(aim, p, up, 4 * size, aim.power(-8, -6.5));
  return scene;
}

class WindowCorners : public tests::DeviceTest {};

TEST_F(WindowCorners, AreWhereAreasCountFrom) {
  const auto exact = reference::make_exact({});
  const auto areas = make_edge_scatter(device(), {{"engine", "native"}, {"rows", "exact"}});
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const tests::OneLightScene scene = at_the_corner(seed, false);
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
      const tests::OneLightScene scene = at_the_corner(seed, true);
      EXPECT_TRUE(tests::equals_truth(scene.floats, scene.light, scene.samples,
                                      tests::run(*method, scene.floats, scene.light, scene.samples)))
          << one.name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace penumbra::volumes
