// SPDX-License-Identifier: Apache-2.0
// Tests domes as suns (maps/host/dome_suns.hpp): the parts into which the sky is cut, and map methods under a sky
// against exact areas and exact masks.

#include "maps/host/dome_suns.hpp"
#include "maps/host/every_light.hpp"
#include "maps/host/median_cut.hpp"
#include "reference/methods.hpp"
#include "tests/analytic/maps/centre_maps.hpp"
#include "volumes/scatter/methods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace penumbra::tests {
namespace {

constexpr std::array<glm::vec3, 3> kAxes{glm::vec3(1, 0, 0), glm::vec3(0, 0, -1), glm::vec3(0, 1, 0)};

/// A floor at height 0, seen from above, under a dome.
scenes::Scene bare_floor_under_dome(const scenes::Dome& dome = {}) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2}).casts_shadow = false;
  scene.lights.emplace_back();
  scene.lights.back().name = "sky";
  scene.lights.back().shape = dome;
  scene.cameras.push_back(camera({0, 4, 2}, {0, 0, 0}));
  return scene;
}

TEST(MedianCut, HalvesTheLongerSide) {
  // Eight directions at one height, in two clusters: the first cut separates the clusters, the next cuts split each
  // cluster by azimuth.
  std::vector<glm::vec3> directions;
  for (const double start : {10.0, 100.0}) {
    for (int i = 0; i < 4; ++i) {
      const double angle = (start + 6 * i) * std::numbers::pi / 180;
      directions.emplace_back(std::sin(angle), 0.2, -std::cos(angle));
    }
  }
  const auto four = maps::median_cut(directions, kAxes, 4);
  EXPECT_EQ(four, (std::vector<std::vector<std::uint32_t>>{{0, 1}, {2, 3}, {4, 5}, {6, 7}}));
  // Regions near the zenith are narrow even if they span many degrees of azimuth: the cut is by height, over 67°, not
  // by azimuth, over 80°.
  std::vector<glm::vec3> narrow;
  for (const double height : {80.0, 84.0}) {
    for (const double around : {-40.0, 40.0}) {
      const double up = height * std::numbers::pi / 180, turn = around * std::numbers::pi / 180;
      narrow.emplace_back(std::cos(up) * std::sin(turn), std::sin(up), -std::cos(up) * std::cos(turn));
    }
  }
  for (int i = 0; i < 4; ++i) narrow.emplace_back(0, std::sin(0.3), -std::cos(0.3));
  EXPECT_EQ(maps::median_cut(narrow, kAxes, 2), (std::vector<std::vector<std::uint32_t>>{{4, 5, 6, 7}, {0, 1, 2, 3}}));
}

TEST(MedianCut, PartsHaveEqualPower) {
  scenes::Scene scene = bare_floor_under_dome();
  const visibility::Light dome = visibility::make_light(scene, 0, glm::dvec3(0), light_samples(1000));
  for (const std::uint32_t parts : {1U, 7U, 64U, 5000U}) {
    const auto found = maps::median_cut(dome.points, kAxes, parts);
    const std::size_t expected = std::min<std::size_t>(parts, dome.points.size());
    ASSERT_EQ(found.size(), expected);
    std::vector<std::uint32_t> all;
    for (const auto& part : found) {
      EXPECT_LE(part.size(), dome.points.size() / expected + 1);
      all.insert(all.end(), part.begin(), part.end());
    }
    std::ranges::sort(all);
    for (std::uint32_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], i);
  }
}

class DomeSuns : public MapsTest {
 protected:
  struct Entry {
    const char* name;
    Factory make;
    visibility::MethodOptions options;
    double off;  ///< allowed error
  };
  static Masks found(const Entry& entry, const Stage& stage, std::uint32_t suns = 64, std::uint32_t rows = 0) {
    visibility::MethodOptions options = entry.options;
    options.emplace("size", "256");
    const auto method = maps::with_dome_suns(maps::for_every_light(entry.make(device(), options)), suns);
    return run(*method, stage, rows);
  }
  static double error(const Stage& stage, const Masks& one, const Masks& other) {
    return rmse(
        stage, [&](std::size_t i) { return stage.samples.triangle[i] >= 0; },
        [&](std::size_t i) { return static_cast<double>(one.visibility[i] - other.visibility[i]); });
  }
};

TEST_F(DomeSuns, APlaneSeesAllOfThem) {
  for (const bool half : {false, true}) {
    const Stage stage(bare_floor_under_dome({.half = half}), 12, 12, light_samples(256));
    for (const Entry& entry :
         {Entry{"shadow-map", maps::make_shadow_map, {}, 0}, Entry{"pcss", maps::make_pcss, {{"size", "64"}}, 0.003},
          Entry{"backproject", maps::make_backproject, {{"size", "48"}}, 0}}) {
      const Masks all = found(entry, stage, 16);
      for (std::size_t i = 0; i < stage.samples.size(); ++i)
        EXPECT_NEAR(all.visibility[i], 1, entry.off + 1e-5) << entry.name;
    }
  }
}

/// A wall and a slab on a floor, under a sky of one radiance.
TEST_F(DomeSuns, AreCloseToTheSky) {
  scenes::Scene scene = bare_floor_under_dome();
  scene.objects.front().casts_shadow = true;
  add_quad(scene, {1, 0.6, 0}, {0, 0.6, 0}, {0, 0, 1.5});
  add_quad(scene, {-0.6, 0.8, 0.2}, {0.5, 0, 0}, {0, 0.1, 0.6});
  const Stage stage(scene, 24, 24, light_samples(256));
  const Masks exact = tests::run(*reference::make_exact({}), stage);
  const visibility::MethodOptions small{{"size", "128"}};
  const std::vector<Entry> entries{{"shadow-map", maps::make_shadow_map, small, 0.08},
                                   {"pcss", maps::make_pcss, small, 0.05},
                                   {"backproject", maps::make_backproject, {{"size", "64"}}, 0.05}};
  for (const Entry& entry : entries) {
    const Masks one = found(entry, stage, 48);
    EXPECT_LT(error(stage, one, exact), entry.off) << entry.name;
  }
  EXPECT_EQ(found(entries[0], stage, 8, 5).visibility, found(entries[0], stage, 8).visibility)
      << "V does not depend on the tiles";
}

/// Masks have the dome's own light samples: accumulate's bits are those of the exact decision, except near edges, where
/// a texel decides.
TEST_F(DomeSuns, AccumulateHasADomesOwnDirections) {
  scenes::Scene scene = bare_floor_under_dome();
  scene.objects.front().casts_shadow = true;
  add_quad(scene, {1, 0.6, 0}, {0, 0.6, 0}, {0, 0, 1.5});
  const Stage stage(scene, 24, 24, light_samples(100));
  const auto exact = volumes::make_edge_scatter(render::Machine(), {{"engine", "native"}});
  const Masks right = tests::run(*exact, stage);
  const Masks all = found({"accumulate", maps::make_accumulate, {}, 0}, stage, 16);
  std::size_t differing = 0, pairs = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0) continue;
    for (std::uint32_t j = 0; j < stage.light.sample_count(); ++j) {
      ++pairs;
      differing += all.visible(i, j) != right.visible(i, j) ? 1 : 0;
    }
  }
  EXPECT_LT(static_cast<double>(differing), 0.01 * static_cast<double>(pairs)) << differing << " of " << pairs;
  EXPECT_LT(error(stage, all, right), 0.04);
}

TEST_F(DomeSuns, NoneIsTooWide) {
  const Stage stage(bare_floor_under_dome(), 4, 4, light_samples(256));
  for (const bool own : {false, true}) {
    for (const std::uint32_t count : {4U, 6U, 64U}) {
      std::size_t samples = 0;
      for (const maps::DomeSun& sun : maps::dome_suns(stage.light, count, own)) {
        samples += sun.samples.size();
        EXPECT_LE(sun.light.sun->tangent, 3 * std::numbers::sqrt2);
        for (const glm::dvec2& at : sun.light.coordinates) EXPECT_LE(glm::length(at), 1 + 1e-6);
        if (!own) continue;
        for (std::size_t k = 0; k < sun.samples.size(); ++k) {
          const glm::dvec3 d = glm::normalize(glm::dvec3(stage.light.points[sun.samples[k]]));
          EXPECT_LT(glm::length(glm::normalize(glm::dvec3(sun.light.points[k])) - d), 1e-6);
        }
      }
      EXPECT_EQ(samples, stage.light.points.size());
    }
  }
}

}  // namespace
}  // namespace penumbra::tests
