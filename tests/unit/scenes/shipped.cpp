// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/scenes/support.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

// Tests that the shipped scenes load without warnings and contain what tests and pages rely on.
namespace penumbra::test {
namespace {

const std::filesystem::path kScenes = PENUMBRA_SCENES;

scenes::Scene read_shipped(const std::string& name) {
  return scenes::read_scene(kScenes / name);
}

/// Returns the files of all shipped scenes, including those in folders.
std::vector<std::filesystem::path> shipped_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kScenes)) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() == ".json" && !path.filename().string().ends_with(".schema.json")) files.push_back(path);
  }
  return files;
}

TEST(ShippedScenes, AllLoadWithoutAWarning) {
  int count = 0;
  for (const std::filesystem::path& file : shipped_files()) {
    const scenes::Scene scene = scenes::read_scene(file);
    for (const std::string& warning : scene.warnings) {
      // One of the seven kinds of light is a parallelogram.
      EXPECT_TRUE(file.filename() == "lights.json" && warning.find("parallelogram") != std::string::npos)
          << file << ": " << warning;
    }
    // Edges of papers/centred.json pass the light's centre as seen from the picture's middle row, so the
    // picture has an odd number of rows.
    EXPECT_EQ(scene.width, file.filename() == "centred.json" ? 145u : 512u) << file;
    ++count;
  }
  EXPECT_GE(count, 12 + 12);
}

TEST(ShippedScenes, EveryLightIsARectangleThatFacesTheScene) {
  for (const std::filesystem::path& file : shipped_files()) {
    if (file.filename() == "lights.json" || file.parent_path().filename() == "skies") continue;
    const scenes::Scene scene = scenes::read_scene(file);
    for (const scenes::AreaLight& light : scene.lights) {
      ASSERT_TRUE(std::holds_alternative<scenes::Rectangle>(light.shape)) << file;
      const auto& rectangle = std::get<scenes::Rectangle>(light.shape);
      const glm::dvec3 normal = glm::cross(rectangle.half_u, rectangle.half_v);
      EXPECT_GT(glm::dot(normal, scene.cameras[0].target - rectangle.center), 0) << file << " " << light.name;
    }
  }
}

TEST(ShippedScenes, BunnyIsTheDefaultScene) {
  const scenes::Scene scene = read_shipped("bunny.json");
  EXPECT_EQ(scene.soup.triangles.size(), 69'666u + 2);
  glm::dvec3 low(1e9), high(-1e9);
  for (std::size_t i = 0; i < 69'666; ++i) {
    for (const std::uint32_t vertex : scene.soup.triangles[i]) {
      low = glm::min(low, scene.soup.positions[vertex]);
      high = glm::max(high, scene.soup.positions[vertex]);
    }
  }
  EXPECT_NEAR(low.y, 0, 1e-12);
  EXPECT_NEAR(high.y, 2, 1e-12);
  EXPECT_NEAR(low.x + high.x, 0, 1e-12);
  EXPECT_NEAR(low.z + high.z, 0, 1e-12);
  const auto& light = std::get<scenes::Rectangle>(scene.lights[0].shape);
  EXPECT_EQ(light.center, glm::dvec3(0.5, 5, 0.5));
  EXPECT_EQ(light.half_u, glm::dvec3(1, 0, 0));
  EXPECT_EQ(light.half_v, glm::dvec3(0, 0, 1));
  EXPECT_EQ(scene.cameras[0].eye, glm::dvec3(4, 3, 5));
  EXPECT_EQ(scene.cameras[0].target, glm::dvec3(0, 0.8, 0));
  EXPECT_EQ(scene.cameras[0].vertical_fov, 45);
}

TEST(ShippedScenes, TerrainHasAMillionTriangles) {
  EXPECT_EQ(read_shipped("terrain-1m.json").soup.triangles.size(), 1'000'000u);
}

TEST(ShippedScenes, CountsThatTheirPurposeNeeds) {
  EXPECT_EQ(read_shipped("parallel-square.json").soup.triangles.size(), 4u);
  EXPECT_EQ(read_shipped("fusion.json").objects.size(), 4u);
  EXPECT_EQ(read_shipped("thin.json").soup.triangles.size(), 2u + 12 * 43 + 2 * 600 * 10 + 4 * 12 * 13);
}

}  // namespace
}  // namespace penumbra::test
