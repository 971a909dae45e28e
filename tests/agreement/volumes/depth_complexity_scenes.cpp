// SPDX-License-Identifier: Apache-2.0
// Depth complexity on the shipped scenes: every bit equals that of edge scatter and of view-sample mapping, which share
// hardly any arithmetic with it, and hardly any bit differs from the ray caster's.

#include "tests/agreement/differences.hpp"

#include "scenes/formats/reader.hpp"
#include "volumes/counters/methods.hpp"
#include "volumes/scatter/methods.hpp"

#include <filesystem>

namespace penumbra {
namespace {

class DepthScenesBase : public tests::DeviceTest, public testing::WithParamInterface<std::string> {
 protected:
  void check(std::uint32_t size, const visibility::SampleRequest& request) {
    const scenes::Scene scene = scenes::read_scene(std::string(PENUMBRA_SCENES "/") + GetParam());
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const visibility::Light light = visibility::make_light(scene, 0, floats.origin, request);
    render::VisibilityBuffer view(device(), floats);
    const visibility::ViewSamples samples =
        view.render(visibility::make_camera(scene.cameras[0], floats.origin, size, size));
    const auto soup = volumes::make_depth_complexity(device(), {{"engine", "vulkan"}});
    const tests::Masks masks = tests::run(*soup, floats, light, samples);
    const auto native = volumes::make_depth_complexity(device(), {{"engine", "native"}});
    EXPECT_EQ(tests::differing_bits(masks, tests::run(*native, floats, light, samples)), 0U);
    for (const char* search : {"kd-tree", "hemicube"}) {
      const auto searched = volumes::make_depth_complexity(device(), {{"search", search}});
      EXPECT_EQ(tests::differing_bits(masks, tests::run(*searched, floats, light, samples)), 0U) << search;
      EXPECT_GT(searched->counters()["candidateEdges"], 0U) << search;
    }
    const auto mapped = tests::map_view_samples(device(), floats, light, samples);
    EXPECT_EQ(tests::differing_bits(masks, mapped), 0U);
    EXPECT_EQ(masks.visibility, mapped.visibility);
    const bool rows = request.pattern == visibility::SamplePattern::rows;
    if (rows && light.kind == visibility::LightKind::rectangle) {
      const auto scatter = volumes::make_edge_scatter(device(), {});
      EXPECT_EQ(tests::differing_bits(masks, tests::run(*scatter, floats, light, samples)), 0U);
    }
    const auto trace = reference::make_ray_traced({});
    const tests::Differences found =
        tests::differences(floats, samples, light, masks, tests::run(*trace, floats, light, samples));
    EXPECT_GT(found.pairs, 0U);
    EXPECT_LE(static_cast<double>(found.differing), 2e-5 * static_cast<double>(found.pairs_all));
    EXPECT_LE(static_cast<double>(found.differing), 2e-4 * static_cast<double>(found.pairs));
    EXPECT_EQ(found.mapped_right, found.judged) << found.first_wrong;
    fmt::print("{} {}x{} {}: {} of {} pairs are not the ray caster's, {} left to exact predicates\n", scene.name, size,
               size, visibility::name_of(request.pattern), found.differing, found.pairs_all,
               soup->counters()["openPairs"]);
  }
};

std::vector<std::string> scene_files() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(PENUMBRA_SCENES)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".json" && name.find(".schema") == std::string::npos) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string name_of_file(const testing::TestParamInfo<std::string>& info) {
  std::string name = std::filesystem::path(info.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

class DepthScenes : public DepthScenesBase {};
TEST_P(DepthScenes, EveryBitIsThatOfTheOthers) {
  check(32, {});
}
INSTANTIATE_TEST_SUITE_P(Scenes, DepthScenes,
                         testing::Values("contact.json", "fusion.json", "parallel-square.json", "room.json",
                                         "thin.json"),
                         name_of_file);

class DepthScenesFull : public DepthScenesBase {};
TEST_P(DepthScenesFull, EveryBitIsThatOfTheOthers) {
  check(48, {});  // at this size two pixels of large-penumbra are hard
  check(256, {});
  check(96, {1000, 0, 0, visibility::SamplePattern::sobol, 1});
  check(96, {256, 0, 0, visibility::SamplePattern::grid, 0});
  check(96, {200, 0, 0, visibility::SamplePattern::jittered, 3});
}
INSTANTIATE_TEST_SUITE_P(Scenes, DepthScenesFull, testing::ValuesIn(scene_files()), name_of_file);

}  // namespace
}  // namespace penumbra
