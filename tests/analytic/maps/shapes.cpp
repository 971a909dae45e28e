// SPDX-License-Identifier: Apache-2.0
// Tests in closed form the points of a light that maps look from, their windows, and the separation of receivers and
// blockers.

#include "maps/backprojection/soft_shadow_map/soft_scene.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/products/slices.hpp"
#include "tests/analytic/maps/centre_maps.hpp"

#include <array>
#include <numbers>
#include <utility>

namespace penumbra::tests {
namespace {

scenes::Scene under(const decltype(scenes::AreaLight::shape)& shape) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {4, 0, 0}, {0, 0, 4});
  scene.lights.push_back(ceiling_light(5, 1));
  scene.lights.front().shape = shape;
  scene.cameras.push_back(camera({0, 1, 6}, {0, 0, 0}, 60));
  return scene;
}

class MapShapes : public MapsTest {};

// Roberts 2018: multiples of 1 / 1.3247… and of its square, starting from (1/2, 1/2), modulo 1.
TEST_F(MapShapes, ThePatternBeginsWithTheR2Sequence) {
  constexpr std::array<std::pair<double, double>, 3> kFirst{
      {{0.5, 0.5}, {0.25487766624669285, 0.06984029099805315}, {0.0097553324933857, 0.6396805819961063}}};
  const Stage stage(under(scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.9}), 2, 2, light_samples(1));
  const auto pattern = maps::light_pattern(stage.light, maps::light_basis(stage.light), 3);
  for (std::size_t i = 0; i < kFirst.size(); ++i) {
    const auto [x, y] = kFirst.at(i);
    const double radius = 0.9 * std::sqrt(x), angle = 2 * std::numbers::pi * y;
    EXPECT_NEAR(pattern[i].x, radius * std::cos(angle), 1e-6) << i;
    EXPECT_NEAR(pattern[i].y, radius * std::sin(angle), 1e-6) << i;
  }
}

// adaptive-light's unit square on lights that are not rectangles: squares become rings around the centroid. Corners lie
// at 225 degrees and so on of a disk. In a triangle the second corner is a third of the way round, because two
// neighbouring corners and the centroid enclose a third of the area.
TEST_F(MapShapes, TheSquareLiesInRingsOnOtherLights) {
  const Stage round(under(scenes::Disk{{0.2, 5, 0}, {0, -1, 0}, 0.9}), 2, 2, light_samples(1));
  const visibility::LightFrame frame = visibility::light_frame(round.light);
  const maps::LightSquare disk(round.light);
  const auto expect_at = [](const glm::vec3& found, const glm::dvec3& expected) {
    EXPECT_LT(glm::length(glm::dvec3(found) - expected), 1e-6);
  };
  const double diagonal = std::sqrt(0.5);
  expect_at(disk.at({0, 0}), frame.center - diagonal * (frame.u + frame.v));
  expect_at(disk.at({1, 0}), frame.center + diagonal * (frame.u - frame.v));
  expect_at(disk.at({1, 0.5}), frame.center + frame.u);
  expect_at(disk.at({0.75, 0.5}), frame.center + 0.5 * frame.u);
  expect_at(disk.at({0.5, 0.1}), frame.center - 0.8 * frame.v);
  const Stage three(under(scenes::Polygon{{{-1, 5, -0.5}, {1, 5, -0.5}, {0.2, 5, 1}}}), 2, 2, light_samples(1));
  const maps::LightSquare polygon(three.light);
  const glm::dvec3 middle = visibility::center_of(three.light), second(three.light.outline[1]);
  expect_at(polygon.at({0, 0}), three.light.outline[0]);
  expect_at(polygon.at({1, 1.0 / 3}), second);
  expect_at(polygon.at({0.75, 0.5 - 1.0 / 12}), 0.5 * (middle + second));
}

// A floor of ±4 at depth 5 is ±0.8 wide. Casters at depth 3 that shade it from a light of half-size 1 are seen up to 1
// (1/3 − 1/5) beside it. A texel is added on every side; `size` − 2 texels make up the rest.
TEST_F(MapShapes, AWindowHoldsReceiversWhatShadesThemAndATexel) {
  constexpr std::uint32_t kSize = 64;
  scenes::Scene scene = under(scenes::Rectangle{{0, 5, 0}, {1, 0, 0}, {0, 0, 1}});
  add_quad(scene, {0, 2, 0}, {8, 0, 0}, {0, 0, 8}).receives_shadow = false;
  const Stage stage(scene, 2, 2, light_samples(1));
  const maps::LightBasis basis = maps::light_basis(stage.light);
  const glm::vec3 centre(basis.center);
  for (const double reach : {0.0, 1.0}) {
    const auto fitted = maps::fit_views(stage.floats, stage.light, basis, std::span(&centre, 1),
                                        {.size = kSize, .reach = glm::dvec2(reach)});
    ASSERT_EQ(fitted.faces, 1U);
    const maps::gpu::SideView& side = fitted.views.front().side[0];
    const double half = 0.8 + reach * (1.0 / 3 - 1.0 / 5), expected = half + 2 * half / (kSize - 2);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(side.upper[axis], expected, 1e-6) << reach;
      EXPECT_NEAR(side.lower[axis], -expected, 1e-6) << reach;
    }
  }
}

// soft-shadow-map's receiver is the object with the largest area toward the light: a floor, not a larger wall that is
// seen edge-on.
TEST_F(MapShapes, TheReceiverIsTheLargestAsTheLightSeesIt) {
  scenes::Scene scene = under(scenes::Rectangle{{0, 5, 0}, {1, 0, 0}, {0, 0, 1}});
  add_quad(scene, {0.1, -10, 0}, {0, 9, 0}, {0, 0, 9});
  const Stage stage(scene, 2, 2, light_samples(1));
  const maps::SoftScene parts = maps::part_scene(stage.floats, stage.light, maps::light_basis(stage.light));
  for (std::size_t i = 0; i < parts.receivers.size(); ++i) {
    EXPECT_EQ(parts.receivers[i], stage.floats.object[i] == 0 ? 1 : 0) << i;
    EXPECT_EQ(parts.occluders[i], stage.floats.object[i] == 0 ? 0 : 1) << i;
  }
}

// If all casters are seen edge-on, convolution's plane is at the mean height of their triangles: here of an upright
// board between depths 2 and 3.5, whose triangles' middles are at 2.5 and 3, and of one between 2 and 2.3.
TEST_F(MapShapes, UprightBlockersCountByTheirTriangles) {
  scenes::Scene scene = under(scenes::Rectangle{{0, 5, 0}, {1, 0, 0}, {0, 0, 1}});
  scene.objects[0].casts_shadow = false;
  add_quad(scene, {0.5, 2.25, 0}, {0, 0.75, 0}, {0, 0, 1}).receives_shadow = false;
  add_quad(scene, {1, 2.85, 0}, {0, 0.15, 0}, {0, 0, 1}).receives_shadow = false;
  const Stage stage(scene, 2, 2, light_samples(1));
  const CentreMaps maps(device(), stage, 16);
  EXPECT_NEAR(maps::slice_planes(maps.set(stage), maps::SliceRule::one_plane, 1).plane[0][0], (2.75 + 2.15) / 2, 1e-6);
}

}  // namespace
}  // namespace penumbra::tests
