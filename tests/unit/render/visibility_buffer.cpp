// SPDX-License-Identifier: Apache-2.0
// Tests that rasterised view samples equal their definition bit for bit, also where triangles coincide, cross each
// other, cross the eye's plane or are seen edge-on.

#include "tests/agreement/lattice.hpp"
#include "tests/agreement/support.hpp"

#include "engines/vectors/scan_conversion.hpp"
#include "render/visibility_buffer.hpp"
#include "scenes/formats/reader.hpp"
#include "selftest/rasteriser_checks.hpp"
#include "tests/unit/passed.hpp"

#include <algorithm>

namespace penumbra::render {
namespace {

using visibility::ViewSamples;

class VisibilityBufferTest : public tests::DeviceTest {
 protected:
  /// Compares both rasterisers and the processor. Returns the number of pixels that see something.
  static std::size_t check(const scenes::Scene& scene, std::uint32_t width, std::uint32_t height,
                           const std::string& what) {
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    std::size_t covered = 0;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
      SCOPED_TRACE(fmt::format("{}, camera {}", what, i));
      const auto camera = visibility::make_camera(scene.cameras[i], floats.origin, width, height);
      const ViewSamples expected = visibility::brute_force_view_samples(floats, camera);
      using enum selftest::ViewSampler;
      for (const selftest::ViewSampler sampler : {vulkan, opengl, vectors}) {
        tests::expect_passed(selftest::check_view_samples(device(), floats, expected, sampler));
      }
      covered += static_cast<std::size_t>(std::ranges::count_if(expected.triangle, [](auto t) { return t >= 0; }));
    }
    return covered;
  }
};

TEST_F(VisibilityBufferTest, EqualsItsDefinitionOnLatticeSoups) {
  // Cameras stand on the lattice among the triangles: many cross the eye's plane, some pass through the eye.
  std::size_t covered = 0;
  for (std::uint32_t seed = 0; seed < 80; ++seed) {
    tests::LatticeSoup soup(seed, 1 + static_cast<int>(seed % 4));
    visibility::SampleRequest request;
    covered += check(lattice_scene(soup, request), 31, 23, "seed " + std::to_string(seed));
  }
  EXPECT_GT(covered, 80U * 31 * 23 / 4);
}

TEST_F(VisibilityBufferTest, EqualsItsDefinitionOnCrossingSoups) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
    scenes::Scene scene;
    std::vector<tests::Corners> soup;
    for (int i = 0; i < 200; ++i) {
      // Sizes range from specks below a pixel to triangles that reach far behind the eye.
      const glm::dvec3 center = point(1);
      const double size = std::ldexp(4.0, -static_cast<int>(random() % 12));
      soup.push_back({center + point(size), center + point(size), center + point(size)});
    }
    tests::add_object(scene, "soup", soup);
    scene.lights.push_back(tests::ceiling_light(3, 1));
    scene.cameras.push_back(tests::camera(point(1), point(1), 90));
    scene.cameras.push_back(tests::camera(point(4), point(0.1), 40));
    scene.cameras.push_back(tests::camera(point(400), point(0.1), 0.5));
    scene.cameras.push_back(tests::camera(point(1), point(1), 175));
    for (const double shift : {0.4, 3.0}) {
      scene.cameras.push_back(tests::camera(point(2), point(0.1), 50));
      scene.cameras.back().shift = {shift * real(random), shift * real(random)};
    }
    check(scene, 48, 37, "seed " + std::to_string(seed));
  }
}

TEST_F(VisibilityBufferTest, EqualsItsDefinitionOnTheBunny) {
  EXPECT_GT(check(scenes::read_scene(PENUMBRA_SCENES "/bunny.json"), 64, 64, "bunny"), 2000U);
}

TEST_F(VisibilityBufferTest, TheProcessorFindsTheSameWhereMuchIsHidden) {
  // The scene has more triangles than one batch of the scan conversion, from specks to ones larger than the picture,
  // whose size is not a multiple of a tile's. The device's result is the reference, as testing every triangle at every
  // pixel would take minutes.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
  scenes::Scene scene;
  std::vector<tests::Corners> soup;
  for (int i = 0; i < 150'000; ++i) {
    const glm::dvec3 center = point(1);
    const double size = i % 5000 == 0 ? 3 : std::ldexp(0.25, -static_cast<int>(random() % 10));
    const double thickness = i % 7 == 0 ? 1e-9 : 1;  // some are needles
    const glm::dvec3 along = point(size);
    soup.push_back({center, center + along, center + 0.7 * along + point(size * thickness)});
  }
  tests::add_object(scene, "soup", soup);
  scene.cameras.push_back(tests::camera({0, 0.3, 4}, {0, 0, 0}, 35));
  scene.cameras.push_back(tests::camera({0.1, 0.2, 0.3}, {1, 0, 0.2}, 120));
  const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  VisibilityBuffer buffer(device(), floats);
  for (const scenes::Camera& camera : scene.cameras) {
    const auto pinhole = visibility::make_camera(camera, floats.origin, 203, 117);
    const ViewSamples expected = buffer.render(pinhole), found = vectors::scan_view_samples(floats, pinhole);
    EXPECT_EQ(found.triangle, expected.triangle);
    EXPECT_EQ(found.p, expected.p);
  }
}

TEST_F(VisibilityBufferTest, ListsOfTilesThatAreFullAreEmptiedOnTheWay) {
  // Each triangle is in the lists of all 64 tiles, and occurs twice: the first of the two must be the carrier.
  scenes::Scene scene;
  std::vector<tests::Corners> soup;
  for (int i = 0; i < 3000; ++i) {
    const double z = -1 - 0.001 * ((i / 2 * 7) % 1500);
    soup.push_back({glm::dvec3(-90, -90, z), glm::dvec3(90, -90, z), glm::dvec3(0, 120, z)});
  }
  tests::add_object(scene, "stack", soup);
  scene.cameras.push_back(tests::camera({0, 0, 4}, {0, 0, 0}, 35));
  const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  const auto pinhole = visibility::make_camera(scene.cameras[0], floats.origin, 512, 128);
  const std::vector<std::int32_t> all(pinhole.width * std::size_t{pinhole.height},
                                      visibility::carrier_of(floats, pinhole, 128, 64));
  EXPECT_EQ(vectors::scan_view_samples(floats, pinhole).triangle, all);
}

TEST_F(VisibilityBufferTest, AFewPixelsAndNoTriangles) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  scene.cameras.push_back(tests::camera({0, 2, 6}, {0, 0, 0}));
  EXPECT_EQ(check(scene, 1, 1, "one pixel"), 1U);
  check(scene, 257, 1, "a row");
  check(scene, 1, 257, "a column");
  scene.cameras[0] = tests::camera({0, 2, 6}, {0, 4, 9});
  EXPECT_EQ(check(scene, 16, 16, "nothing in sight"), 0U);
  tests::add_object(scene, "needle", {{glm::dvec3(0), glm::dvec3(1), glm::dvec3(2)}});
  scene.soup.triangles.erase(scene.soup.triangles.begin(), scene.soup.triangles.begin() + 2);
  scene.soup.object.erase(scene.soup.object.begin(), scene.soup.object.begin() + 2);
  scene.cameras[0] = tests::camera({0, 2, 6}, {0, 0, 0});
  EXPECT_EQ(check(scene, 16, 16, "nothing with area"), 0U);
}

}  // namespace
}  // namespace penumbra::render
