// hybrid-volume: the map's answer where its texels agree, that of shadow volumes elsewhere.

#include "hybrids/methods.hpp"

#include "maps/filters/methods.hpp"
#include "tests/agreement/support.hpp"
#include "tests/unit/shipped_scene.hpp"
#include "volumes/soft/methods.hpp"

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
    // Mostly those near contacts, where the map's bias forgives a shadow.
    EXPECT_LT(differing, wrong_map / 2 + 1) << name;
    EXPECT_LT(all.counters.at("countUpdates"), all.of_volumes.at("countUpdates") / 2) << name << ": the mask";
  }
}

/// Of a board far from the floor the map is right but at its outline: V is that of volumes everywhere.
TEST_F(HybridVolume, IsExactWhereTheMapSeesEveryOutline) {
  const Answers all = ask(stage_of(shipped_scene("parallel-square")), "64");
  EXPECT_EQ(all.hybrid, all.volumes);
  EXPECT_NE(all.map, all.volumes);
}

/// What the map does not see at all has no silhouette, as published: a bar between texels' centres.
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

}  // namespace
}  // namespace penumbra::tests
