// SPDX-License-Identifier: Apache-2.0
// Tests hybrid-volume: the map's answer where its texels agree, the answer of shadow volumes elsewhere.

#include "hybrids/methods.hpp"

#include "maps/filters/methods.hpp"
#include "tests/agreement/support.hpp"
#include "tests/unit/shipped_scene.hpp"
#include "volumes/soft/methods.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::tests {
namespace {

class HybridVolume : public DeviceTest {
 protected:
  struct Answers {
    std::vector<float> hybrid, map, volumes;
    std::map<std::string, std::uint64_t> counters, of_volumes;
  };
  static Answers ask(const Stage& stage, const std::string& size) {
    const auto hybrid = hybrids::make_hybrid_volume(device(), {{"size", size}});
    const auto volumes = volumes::make_hard_volume(device(), {});
    const auto map = maps::make_pcf(device(), {{"size", size}, {"window", "1"}, {"weights", "bilinear"}});
    Answers answers;
    answers.hybrid = run(*hybrid, stage).visibility;
    answers.volumes = run(*volumes, stage).visibility;
    answers.map = run(*map, stage).visibility;
    answers.counters = hybrid->counters();
    answers.of_volumes = volumes->counters();
    EXPECT_EQ(run(*hybrid, stage, 5).visibility, answers.hybrid) << "in tiles";
    return answers;
  }
  static Stage stage_of(const scenes::Scene& scene) {
    return {scene, 64, 48, {16, 0, 0, visibility::SamplePattern::grid, 0}};
  }
};

TEST_F(HybridVolume, AsksVolumesWhereTexelsDisagree) {
  for (const char* name : {"parallel-square", "contact", "fusion"}) {
    const Stage stage = stage_of(shipped_scene(name));
    const Answers all = ask(stage, "128");
    std::uint64_t silhouettes = 0, differing = 0, wrong_map = 0;
    for (std::size_t i = 0; i < all.hybrid.size(); ++i) {
      const bool agree = all.map[i] == 0 || all.map[i] == 1;
      silhouettes += agree ? 0 : 1;
      EXPECT_EQ(all.hybrid[i], agree ? all.map[i] : all.volumes[i]) << name << ", pixel " << i;
      differing += all.hybrid[i] != all.volumes[i] ? 1 : 0;
      wrong_map += (all.map[i] < 0.5F) != (all.volumes[i] < 0.5F) ? 1 : 0;
    }
    EXPECT_EQ(all.counters.at("silhouettePixels"), silhouettes) << name;
    EXPECT_GT(silhouettes, 20U) << name;
    EXPECT_LT(silhouettes, all.hybrid.size() / 4) << name;
    // The differing pixels are mostly near contacts, where the map's bias removes a shadow.
    EXPECT_LT(differing, wrong_map / 2 + 1) << name;
    EXPECT_LT(all.counters.at("countUpdates"), all.of_volumes.at("countUpdates") / 2)
        << name << ": the stencil mask of silhouette pixels must save updates";
  }
}

/// A map of a board far from the floor is right except at the board's outline, so V equals that of volumes everywhere.
TEST_F(HybridVolume, IsExactWhereTheMapSeesEveryOutline) {
  const Answers all = ask(stage_of(shipped_scene("parallel-square")), "64");
  EXPECT_EQ(all.hybrid, all.volumes);
  EXPECT_NE(all.map, all.volumes);
}

/// An object that the map misses entirely, such as a bar between texels' centres, has no silhouette, as published.
TEST_F(HybridVolume, WhatNoTexelSeesIsLost) {
  scenes::Scene scene;
  add_object(scene, "floor", quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}));
  add_object(scene, "bar", quad({0, 2, 0}, {0.003, 0, 0}, {0, 0, -0.8}));
  scene.lights.push_back(ceiling_light(5, 0.3));
  scene.cameras.push_back(camera({0, 1.5, 0}, {0, 0, 0}, 90));
  scene.cameras.back().up = {0, 0, -1};
  const Stage stage(scene, 257, 33, {16, 0, 0, visibility::SamplePattern::grid, 0});
  const Answers all = ask(stage, "64");
  EXPECT_GT(std::ranges::count(all.volumes, 0.0F), 10);
  EXPECT_EQ(std::ranges::count(all.hybrid, 0.0F), 0);
}

/// Shadow volumes made from a shadow map.
class ReconstructedVolume : public HybridVolume {
 protected:
  static std::unique_ptr<visibility::Method> method(const char* size) {
    return hybrids::make_hybrid_volume(device(), {{"variant", "mccool"}, {"size", size}});
  }
  /// Two boards over a floor, one of them partly in the other's shadow.
  static scenes::Scene boards() {
    scenes::Scene scene;
    add_object(scene, "floor", quad({0, 0, 0}, {3, 0, 0}, {0, 0, -3}));
    add_object(scene, "upper", quad({0.1, 3, 0}, {0.4, 0, 0.1}, {0.1, 0, -0.4}));
    add_object(scene, "lower", quad({0.6, 1.5, 0.2}, {0.5, 0, -0.2}, {-0.2, 0, -0.5}));
    scene.lights.push_back(ceiling_light(6, 0.3));
    scene.cameras.push_back(camera({2.5, 4.5, 3}, {0.2, 0, 0}));
    return scene;
  }
};

/// Volumes whose walls run along texels' borders. For flat boards V equals that of the map's nearest texel: seen from
/// outside, seen from within the shadow, and with the map as a hemicube, which a wall up to the light's plane makes
/// necessary. Only a few pixels may differ, at outlines of shadows or of boards in the picture: a texel extends up to
/// half its size beyond the board that it shows, and there a volume without cap may be entered unnoticed.
TEST_F(ReconstructedVolume, OfFlatBoardsIsTheMap) {
  for (const std::string place : {"outside", "within the shadow", "hemicube"}) {
    scenes::Scene scene = boards();
    if (place == "hemicube") add_object(scene, "wall", quad({-3, 4, 0}, {0, 4, 0}, {0, 0, 3}));
    if (place == "within the shadow") scene.cameras[0] = camera({0.2, 1, 0.1}, {1, 0, 0.6}, 100);
    const Stage stage(scene, 96, 72, {16, 0, 0, visibility::SamplePattern::grid, 0});
    const auto reconstructed = method("64");
    const std::vector<float> found = run(*reconstructed, stage).visibility;
    const std::vector<float> right = run(*maps::make_shadow_map(device(), {{"size", "64"}}), stage).visibility;
    const std::vector<float> four =
        run(*maps::make_pcf(device(), {{"size", "64"}, {"window", "1"}, {"weights", "bilinear"}}), stage).visibility;
    const auto is_beside_board = [&](std::size_t pixel) {
      for (const std::ptrdiff_t step : {-97, -96, -95, -1, 1, 95, 96, 97}) {
        const auto other = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(pixel) + step, 0, std::ssize(found) - 1));
        if (std::abs(stage.samples.p[other].y - stage.samples.p[pixel].y) > 0.5F) return true;
      }
      return false;
    };
    std::size_t wrong = 0, dark = 0, away_from_outlines = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      dark += right[i] == 0 ? 1 : 0;
      if (found[i] == right[i]) continue;
      ++wrong;
      away_from_outlines += (four[i] == 0 || four[i] == 1) && !is_beside_board(i) ? 1 : 0;
    }
    EXPECT_LE(wrong, place == "within the shadow" ? 2U : 12U) << place;
    EXPECT_EQ(away_from_outlines, 0U) << place;
    EXPECT_GT(dark, 300U) << place;
    EXPECT_GT(reconstructed->counters().at("walls"), 60U) << place;
    EXPECT_EQ(run(*reconstructed, stage, 5).visibility, found) << "in tiles; " << place;
  }
}

/// Without any bias, surfaces hardly shade themselves: a shadow map without bias has several times as many wrong
/// pixels.
TEST_F(ReconstructedVolume, NeedsNoBias) {
  for (const auto& [name, size] : {std::pair("contact", "256"), std::pair("fusion", "1024")}) {
    const Stage stage = stage_of(shipped_scene(name));
    const std::vector<float> right = run(*volumes::make_hard_volume(device(), {}), stage).visibility;
    const auto wrong = [&](const std::unique_ptr<visibility::Method>& one) {
      const std::vector<float> found = run(*one, stage).visibility;
      std::size_t count = 0;
      for (std::size_t i = 0; i < found.size(); ++i) count += found[i] != right[i] ? 1 : 0;
      return count;
    };
    const std::size_t reconstructed = wrong(method(size)),
                      biased = wrong(maps::make_shadow_map(device(), {{"size", size}})),
                      unbiased = wrong(
                          maps::make_shadow_map(device(), {{"size", size}, {"bias", "0"}, {"receiverPlane", "off"}}));
    fmt::print("{}, wrong: reconstructed {}, map {}, without bias {}\n", name, reconstructed, biased, unbiased);
    EXPECT_LT(4 * reconstructed, unbiased) << name;
    EXPECT_LT(reconstructed, 3 * biased + 10) << name;
  }
}

}  // namespace
}  // namespace penumbra::tests
