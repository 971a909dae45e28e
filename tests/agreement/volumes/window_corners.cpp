// SPDX-License-Identifier: Apache-2.0
// Edges seen at the corner of a light's window by view samples close together. The number of layers over that corner is
// counted in two ways: by floats at the place that they compute, and in double at the exact place. One must not be
// taken for the other.

#include "base/error.hpp"
#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/volumes/aimed_scene.hpp"
#include "tests/agreement/volumes/exact_rows.hpp"
#include "visibility/lights/device_light.hpp"
#include "volumes/edges/light_window.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

namespace penumbra::volumes {
namespace {

/// Returns a polygon light, and a triangle with an edge in front of its window's corner as p sees it. With `inside`,
/// the edge is between two triangles that together hide everything around it.
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

/// Returns a light of a few ulps, whose frame has rounding errors as large as itself, and an edge that p sees between
/// the frame's corner and the same place in the plane of the stored points: 20 scenes for each light. Returns nullopt
/// if the two places are closer than 1.5 times the light samples' deviation.
std::optional<tests::OneLightScene> at_the_frames_corner(std::uint32_t scene_seed) {
  const std::uint32_t seed = scene_seed / 20;
  tests::Draws aim(seed);
  const double ulp = 0x1p-24, size = ulp * aim.power(0.3, 3);
  const glm::dvec3 center(aim.real(-0.9, 0.9), aim.real(-0.9, 0.9), aim.real(-0.9, 0.9)), n = aim.direction();
  scenes::LightShape shape = scenes::Disk{center, n, size};
  if (seed % 2 == 0) {
    const glm::dvec3 u = aim.across(n);
    shape = scenes::Ellipse{center, size * u, size * aim.power(-1, 0) * glm::cross(n, u)};
  }
  tests::OneLightScene scene(shape, {1 + seed % 3, 0, 0, visibility::SamplePattern::jittered, seed % 9});
  const auto frame = visibility::light_frame(scene.light);
  const visibility::DeviceLight light = visibility::make_device_light(scene.light, 1);
  const glm::dvec3 across = glm::normalize(glm::cross(frame.u, frame.v));
  const glm::dvec3 placed = glm::dvec3(light.center) - glm::dvec3(light.u) - glm::dvec3(light.v),
                   counted = placed - glm::dot(placed - frame.center, across) * across;
  if (glm::distance(placed, counted) < 1.5 * static_cast<double>(light.deviation)) return std::nullopt;
  aim = tests::Draws(scene_seed);
  const glm::dvec3 side = aim.across(across);
  const double away = size * aim.power(-0.5, 1.5) + 16 * ulp, lean = aim.real(0.2, 1.5);
  const glm::dvec3 p = counted + away * (std::cos(lean) * (seed % 4 < 2 ? 1.0 : -1.0) * across + std::sin(lean) * side);
  const glm::dvec3 toward = counted + aim.real(0, 1) * (placed - counted) - p;
  const glm::dvec3 along = glm::normalize(glm::cross(glm::normalize(toward), across)),
                   beside = glm::cross(along, glm::normalize(toward));
  const double width = size * aim.power(-0.5, 1), share = aim.real(0.2, 0.98);
  const double sign = aim.real(-1, 1) < 0 ? -1 : 1;
  scene.add_occluder({{p + share * toward + width * along, p + (share + aim.real(-0.1, 0.02)) * toward - width * along,
                       p + share * toward + sign * width * beside}});
  scene.look_from(aim, p, glm::normalize(-glm::normalize(toward) + 0.5 * aim.direction()), 0.02,
                  ulp * aim.power(-0.5, 1));
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

/// Seeds among the first million that are wrong if the deviation leaves out the distance between the frame's corner and
/// the counted one.
constexpr std::array<std::uint32_t, 6> kRoundedFrames{17465, 58142, 104227, 142683, 162197, 258853};

/// Returns the number of scenes; lights whose shape floats cannot represent are refused.
std::size_t are_right(const render::Device& device, std::span<const std::uint32_t> seeds) {
  const std::array methods{tests::kNativeEdgeScatter.make(device, {}), tests::kNativeDepthComplexity.make(device, {})};
  std::size_t scenes = 0;
  for (const std::uint32_t seed : seeds) {
    try {
      const auto scene = at_the_frames_corner(seed);
      if (!scene) continue;
      for (const auto& method : methods) {
        EXPECT_TRUE(tests::equals_truth(scene->floats, scene->light, scene->samples,
                                        tests::run(*method, scene->floats, scene->light, scene->samples)))
            << "method " << (method == methods[0] ? 0 : 1) << ", seed " << seed;
      }
      ++scenes;
    } catch (const InputError&) {
    }
  }
  return scenes;
}
TEST_F(WindowCorners, OfARoundedFrameAreWhereMasksCountFrom) {
  EXPECT_EQ(are_right(device(), kRoundedFrames), kRoundedFrames.size());
}
TEST_F(WindowCorners, OfARoundedFrameAreWhereMasksCountFromFull) {
  std::vector<std::uint32_t> seeds(1000000);
  std::iota(seeds.begin(), seeds.end(), 0);
  EXPECT_GT(are_right(device(), seeds), seeds.size() / 200);
}

}  // namespace
}  // namespace penumbra::volumes
