// SPDX-License-Identifier: Apache-2.0
// Tests the other ways to measure the part beyond an edge: a table, and a texture texel by texel.

#include "tests/agreement/volumes/soft_stage.hpp"

#include "volumes/soft/coverage_table.hpp"
#include "volumes/soft/methods.hpp"
#include "volumes/wedges/texture_weights.hpp"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace penumbra::volumes {
namespace {

using tests::Errors;
using tests::SoftStage;

class SoftVolumeMeasures : public tests::DeviceTest {
 protected:
  static std::vector<float> run(const SoftStage& stage, const visibility::MethodOptions& options = {}) {
    return stage.run(*make_soft_volume(device(), options));
  }
  static void make_disk(scenes::Scene& scene) {
    const auto rectangle = std::get<scenes::Rectangle>(scene.lights.at(0).shape);
    scene.lights[0].shape =
        scenes::Disk{rectangle.center, glm::cross(rectangle.half_u, rectangle.half_v), glm::length(rectangle.half_u)};
  }
  /// Compares each pixel with the twin. The twin gives each edge its whole weight separately, while the shader's
  /// weights depend on neighbouring edges. Tolerance: that of soft_volume_twin.cpp, and for each edge on the light four
  /// walks over texels (one by the shader, three by the twin), each off by at most 2⁻²⁴ · brightest if the edge is
  /// nearly upright (property/volumes/coverage_textures.cpp).
  static void expect_twin(const SoftStage& stage, const std::vector<float>& found, const std::string& name) {
    const Casters casters = casters_of(stage.floats, stage.light);
    const SoftVisibility soft(stage.floats, stage.light, casters);
    double largest = 0, loosest = 0;
    std::size_t penumbra = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!stage.judged(i)) continue;
      const LayerSum layers = soft.at(stage.lit(i), Viewer::center);
      double walks = 0;
      for (const CoveredEdge& edge : layers.edges) walks += 4 * std::abs(edge.multiplicity);
      const double tolerance = 0x1p-25 + 0x1p-33 * static_cast<double>(casters.graph.edges.size()) + 1e-10 +
                               walks * 0x1p-24 * soft.texture()->brightest();
      const double error = std::abs(found[i] - layers.visibility);
      ASSERT_LE(error, tolerance) << name << ", pixel " << i << ": " << found[i] << ", the twin " << layers.visibility;
      largest = std::max(largest, error);
      loosest = std::max(loosest, tolerance);
      penumbra += layers.visibility > 0 && layers.visibility < 1 ? 1 : 0;
    }
    fmt::print("{}: {} in penumbra, off by {:.1e} at most (allowed: {:.1e})\n", name, penumbra, largest, loosest);
    EXPECT_GT(penumbra, 50U) << name;
  }
  /// Returns a checkered texture with a dark corner.
  static scenes::Texture checkered(std::uint32_t width, std::uint32_t height) {
    scenes::Texture texture;
    texture.width = width;
    texture.height = height;
    for (std::uint32_t i = 0; i < width * height; ++i) {
      const float bright = i == 0 ? 0.0F : 0.25F + 0.5F * static_cast<float>((i % width + i / width) % 2);
      texture.texels.emplace_back(bright, 0.8F * bright, 0.5F);
    }
    return texture;
  }
};

TEST_F(SoftVolumeMeasures, TheTableKeepsWithinItsBound) {
  for (const char* name : {"fusion", "parallel-square", "broken"}) {
    for (const bool disk : {false, true}) {
      scenes::Scene scene = tests::shipped_scene(name);
      if (disk) make_disk(scene);
      const SoftStage stage(scene, device(), 40, 30);
      const Casters casters = casters_of(stage.floats, stage.light);
      const SoftVisibility soft(stage.floats, stage.light, casters);
      const std::vector<float> found = run(stage, {{"coverage", "table"}});
      const double reach = disk ? kDiskTableReach : kRectangleTableReach;
      double largest = 0, tightest = 1;
      std::size_t moved = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (!stage.judged(i)) continue;
        const LayerSum layers = soft.at(stage.lit(i), Viewer::center);
        double swept = 0;
        for (const CoveredEdge& edge : layers.edges) {
          // The edge's ends move by at most `reach`, so its length grows by at most twice that.
          const double length = glm::length(edge.clipped.to - edge.clipped.from);
          swept += std::abs(edge.multiplicity) * reach * (length + (length + 2 * reach)) / 2;
        }
        // 1e-6 is above the tolerance of soft_volume_twin.cpp for 8,000 edges.
        const double bound = swept / soft.outline().area + 1e-6, error = std::abs(found[i] - layers.visibility);
        ASSERT_LE(error, bound) << name << ", pixel " << i;
        largest = std::max(largest, error);
        if (swept > 0) tightest = std::min(tightest, bound - error);
        moved += error > 1e-6 ? 1 : 0;
      }
      fmt::print("{}, {}: the table is off by {:.4f} at most; its bound is not nearer than {:.4f}\n", name,
                 disk ? "disk" : "rectangle", largest, tightest);
      EXPECT_GT(moved, 10U) << name;
    }
  }
}

TEST_F(SoftVolumeMeasures, TexturesAreIntegratedTexelByTexel) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {2u, 3u}, {7u, 5u}, {64u, 64u}}) {
    scenes::Scene scene = tests::shipped_scene("fusion");
    scene.lights[0].texture = checkered(width, height);
    if (width == 1) scene.lights[0].texture->texels = {glm::vec3(1)};
    const SoftStage stage(scene, device(), 40, 30);
    const std::vector<float> found = run(stage);
    expect_twin(stage, found, fmt::format("{}x{} texels", width, height));
    if (width > 1) continue;
    scene.lights[0].texture.reset();
    const Errors plain = tests::errors_of(found, SoftStage(scene, device(), 40, 30).twin(Viewer::center));
    EXPECT_LE(plain.largest, 1e-6) << "a texture of one texel must change nothing";
  }
}

TEST_F(SoftVolumeMeasures, TheShippedTexturedLight) {
  const SoftStage stage(tests::shipped_scene("textured-light"), device(), 48, 48);
  ASSERT_TRUE(stage.light.texture);
  expect_twin(stage, run(stage), "textured-light");
}

/// Boards side by side, so that the method's model holds: exact areas give the part of the texture that they hide.
TEST_F(SoftVolumeMeasures, TexturedLightsAgreeWithTheExactArea) {
  scenes::Scene scene = tests::floor_and_light(0.4);
  for (int i = 0; i < 9; ++i) {
    const int column = i % 3, row = i / 3;
    const glm::dvec3 center((column - 1) * 1.2, 0.3 + 0.06 * i, (row - 1) * 1.2);
    tests::add_object(scene, "board", tests::quad(center, {0.25, 0.03, 0.1 * (i % 4)}, {-0.1 * (i % 4), 0.05, 0.2}));
  }
  scene.lights[0].texture = checkered(5, 4);
  const SoftStage stage(scene, device(), 64, 48);
  const std::vector<double> exact = stage.exact();
  for (const char* split : {"1", "3"}) {
    const Errors errors = tests::errors_of(run(stage, {{"split", split}}), exact);
    fmt::print("boards under a texture, split {}: {} in penumbra, off by {:.1e} at most\n", split, errors.penumbra,
               errors.largest);
    EXPECT_LE(errors.largest, 2e-3);
    EXPECT_GT(errors.penumbra, 100U);
  }
  const Errors table = tests::errors_of(run(stage, {{"coverage", "table"}}), exact);
  fmt::print("boards under a texture, by a table: off by {:.4f} at most\n", table.largest);
  // A convex region of [−1, 1]² has a perimeter of at most 8, also after its corners are moved, so its area is off by
  // at most 2 · reach of the whole; and no texel is brighter than twice the mean.
  EXPECT_LE(table.largest, 4 * kRectangleTableReach);
}

TEST_F(SoftVolumeMeasures, ATextureIsRefusedWhereItIsTooWide) {
  visibility::LightTexture texture{0x10000, 1, {}, std::vector<double>(0x10000, 1.0), 1};
  EXPECT_THROW(TextureWeights{texture}, ResourceError);
}

/// The light's outline, and the table's 1024 points on it: 32 rows from corner to corner, or 16 circles of 64 points.
struct TablePoints {
  LightOutline outline;
  glm::dvec2 (*at)(int index);
};
const TablePoints kRectanglePoints{{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 4}, [](int index) {
                                     return glm::dvec2(2 * (index % 32) - 31, 2 * (index / 32) - 31) / 31.0;
                                   }};
const TablePoints kDiskPoints{{{}, std::numbers::pi}, [](int index) {
                                const int ring = index / 64;
                                const double angle = (index % 64 + 0.5) * std::numbers::pi / 32;
                                return (2 * ring + 1) / 31.0 * glm::dvec2(std::cos(angle), std::sin(angle));
                              }};

TEST(CoverageTable, NoPlaceIsFartherFromItsPointThanIsSaid) {
  for (const auto& [points, reach] :
       {std::pair(kRectanglePoints, kRectangleTableReach), {kDiskPoints, kDiskTableReach}}) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(-1, 1);
    double farthest = 0;
    for (int i = 0; i < 20'000; ++i) {
      const glm::dvec2 q(unit(random), unit(random));
      if (points.outline.corners.empty() && glm::length(q) > 1) continue;
      double nearest = 4;
      for (int index = 0; index < 1024; ++index) nearest = std::min(nearest, glm::length(points.at(index) - q));
      farthest = std::max(farthest, nearest);
    }
    EXPECT_LE(farthest, reach);
    EXPECT_GE(farthest, 0.93 * reach);  // the corners of cells, where the distance is largest, are not all found
  }
}

TEST(CoverageTable, ALoopLeavesItsAreaOut) {
  // The part beyond the three sides is the light without the triangle; the whole light counts as 0 in a closed loop.
  for (const TablePoints& points : {kRectanglePoints, kDiskPoints}) {
    const std::vector<double> table = coverage_table(points.outline, nullptr);
    std::mt19937 random(5);
    for (int i = 0; i < 10'000; ++i) {
      std::array<int, 3> corner{};
      for (int& c : corner) c = static_cast<int>(random() % 1024);
      double sum = 0, twice = 0;
      for (std::size_t side = 0; side < 3; ++side) {
        const int from = corner[side], to = corner[(side + 1) % 3];
        sum += table[static_cast<std::size_t>(from) * 1024 + static_cast<std::size_t>(to)];
        const glm::dvec2 a = points.at(from), b = points.at(to);
        twice += a.x * b.y - a.y * b.x;
      }
      // About twenty rounding errors of numbers below 4.
      ASSERT_NEAR(sum, -0.5 * twice / points.outline.area, 1e-14) << corner[0] << " " << corner[1] << " " << corner[2];
    }
  }
}

TEST(CoverageTable, NothingIsBeyondASideAndASegmentBeyondAChord) {
  const std::vector<double> square = coverage_table(kRectanglePoints.outline, nullptr);
  constexpr std::array kCorners = {31, 1023, 992, 0};  // from the lower right, counter-clockwise
  for (std::size_t i = 0; i < 3; ++i)                  // the last side crosses the direction in which fans begin
    EXPECT_NEAR(square[static_cast<std::size_t>(kCorners[i] * 1024 + kCorners[i + 1])], 0, 1e-15) << i;
  const std::vector<double> disk = coverage_table(kDiskPoints.outline, nullptr);
  for (const int step : {1, 7, 31}) {
    const double angle = step * std::numbers::pi / 32, segment = 0.5 * (angle - std::sin(angle)) / std::numbers::pi;
    EXPECT_NEAR(disk[static_cast<std::size_t>(960 * 1024 + 960 + step)], segment, 1e-15) << step;
  }
}

}  // namespace
}  // namespace penumbra::volumes
