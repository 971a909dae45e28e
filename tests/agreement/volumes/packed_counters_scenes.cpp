// SPDX-License-Identifier: Apache-2.0
// Tests depth-complexity variant=forest on the shipped scenes: its counters equal those of the twins, and where it
// differs from the ray caster it is too bright, never too dark.

#include "tests/agreement/volumes/packed_counters.hpp"
#include "tests/unit/shipped_scene.hpp"

#include "render/visibility_buffer.hpp"

namespace penumbra::volumes {
namespace {

class PackedScenesBase : public tests::DeviceTest, public testing::WithParamInterface<const char*> {
 protected:
  void check(std::uint32_t size, std::size_t by_edges) {
    const scenes::Scene scene = tests::shipped_scene(GetParam());
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const visibility::Light light =
        visibility::make_light(scene, 0, floats.origin, {16, 0, 0, visibility::SamplePattern::rows, 0});
    const visibility::ViewSamples samples =
        render::VisibilityBuffer(device(), floats)
            .render(visibility::make_camera(scene.cameras[0], floats.origin, size, size));
    const auto method = make_packed_counters(device(), {.keeps_counters = true});
    const tests::PackedTotals found = tests::expect_packed(*method, floats, samples, light, by_edges, GetParam());
    EXPECT_GT(found.known, found.pairs / 2);
    EXPECT_GT(found.by_edges, 0U);
    fmt::print("{} {}x{}: {} of {} pairs too bright; {} left open, {} at the horizon\n", GetParam(), size, size,
               found.too_bright, found.pairs, method->counters()["openPairs"], method->counters()["horizonPairs"]);
    expect_never_darker(floats, samples, light, tests::run(*method, floats, light, samples));
  }

 private:
  static void expect_never_darker(const visibility::SceneFloats& floats, const visibility::ViewSamples& samples,
                                  const visibility::Light& light, const tests::Masks& masks) {
    const tests::Masks traced = tests::trace(floats, light, samples);
    for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
      if (samples.triangle[pixel] == visibility::ViewSamples::kBackground) continue;
      for (std::uint32_t j = 0; j < light.sample_count(); ++j) {
        if (masks.visible(pixel, j) || !traced.visible(pixel, j)) continue;
        const auto truth = visibility::decide_pair(floats, samples, pixel, light, j);  // Embree may be wrong
        EXPECT_NE(truth.outcome, visibility::PairOutcome::visible)
            << tests::describe_pair(floats, samples, pixel, light, j);
      }
    }
  }
};

std::string name_of_scene(const testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

class PackedScenes : public PackedScenesBase {};
TEST_P(PackedScenes, CountersEqualTheTwins) {
  check(24, 30);
}
INSTANTIATE_TEST_SUITE_P(Scenes, PackedScenes, testing::Values("contact", "fusion"), name_of_scene);

class PackedScenesFull : public PackedScenesBase {};
TEST_P(PackedScenesFull, CountersEqualTheTwins) {
  check(48, 60);
}
INSTANTIATE_TEST_SUITE_P(Scenes, PackedScenesFull,
                         testing::Values("broken", "bunny", "contact", "fusion", "large-penumbra", "parallel-square",
                                         "room", "self-shadow", "textured-light", "thin"),
                         name_of_scene);

}  // namespace
}  // namespace penumbra::volumes
