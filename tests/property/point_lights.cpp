// SPDX-License-Identifier: Apache-2.0
// Tests edge-scatter on both engines under lights whose samples form no rows: every pair equals the exact decision,
// without tolerance.

#include "tests/agreement/hostile_lamps.hpp"
#include "tests/agreement/lattice.hpp"
#include "tests/agreement/volumes/light_span.hpp"
#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/point_lights.hpp"
#include "tests/agreement/support.hpp"
#include "tests/property/lattice_truth.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <tuple>

namespace penumbra {
namespace {

using tests::PairCounts;
using tests::PointLight;

constexpr std::uint32_t kMostSamples = 70;
/// More than 256 light points are stored in rows of several tiles each on vector units.
constexpr std::uint32_t kMany = 400;

constexpr std::array kEngines{tests::kEdgeScatter, tests::kNativeEdgeScatter};

class PointSoups : public tests::DeviceTest,
                   public testing::WithParamInterface<std::tuple<int, PointLight, tests::MaskMethod>> {
 protected:
  static PairCounts look(const render::Device& device, std::uint32_t first, std::uint32_t count) {
    const auto& [range, kind, engine] = GetParam();
    const auto method = engine.make(device, {});
    PairCounts counts;
    for (std::uint32_t i = first; i < first + count && !HasFailure(); ++i) {
      const std::uint32_t seed = i + 100'000 * static_cast<std::uint32_t>(range);
      tests::LatticeSoup soup(seed, range);
      visibility::SampleRequest request;
      scenes::Scene scene = tests::lattice_scene(soup, request);
      tests::reshape(scene.lights[0], kind, request, soup.random(), i % 12 == 11 ? kMany : kMostSamples);
      const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
      const visibility::Light light = visibility::make_light(scene, 0, floats.origin, request);
      const visibility::ViewSamples samples = tests::all_samples(scene, floats, soup.random());
      const tests::Masks masks = tests::run(*method, floats, light, samples);
      EXPECT_TRUE(equals_truth(floats, light, samples, masks, &counts))
          << "soup " << i << " of range " << range << " under " << kind;
    }
    return counts;
  }
};

TEST_P(PointSoups, EveryPairIsTheExactDecision) {
  const PairCounts counts = look(device(), 0, 25);
  tests::expect_all_kinds(counts);
}
/// Tests 60,000 soups for each kind of light and each engine, on a device without the validation layer, which takes
/// most of the time and reports nothing here that it does not report about the 25 soups of the quick test.
TEST_P(PointSoups, EveryPairFull) {
  constexpr std::uint32_t kSoups = 20'000, kAtOnce = 1000;
  const auto& [range, kind, engine] = GetParam();
  const render::Device device(render::DeviceOptions{});
  PairCounts counts;
  for (std::uint32_t done = 0; done < kSoups && !HasFailure(); done += kAtOnce) {
    counts += look(device, 1000 + done, kAtOnce);
    fmt::print("{} under {} of range {}: {} soups, {} pairs, {} of them by a zero\n", engine.name, name_of(kind), range,
               done + kAtOnce, counts.pairs, counts.zero);
    std::fflush(stdout);
  }
  tests::expect_all_kinds(counts);
}
INSTANTIATE_TEST_SUITE_P(Under, PointSoups,
                         testing::Combine(testing::Values(1, 2, 4), testing::ValuesIn(tests::kPointLights),
                                          testing::ValuesIn(kEngines)),
                         [](const auto& it) {
                           return fmt::format("{}_{}_{}", std::get<2>(it.param).name, name_of(std::get<1>(it.param)),
                                              std::get<0>(it.param));
                         });

/// Panels in, near and through the light's plane, with mixed magnitudes and needles.
class PointLamps : public tests::DeviceTest,
                   public testing::WithParamInterface<std::tuple<tests::Hostility, PointLight, tests::MaskMethod>> {
 protected:
  static void look(std::uint32_t first, std::uint32_t count) {
    const auto& [hostility, kind, engine] = GetParam();
    const auto method = engine.make(device(), {});
    PairCounts counts;
    std::uint32_t refused = 0;
    for (std::uint32_t seed = first; seed < first + count && !HasFailure(); ++seed) {
      tests::HostileLamp lamp(hostility, seed);
      scenes::Scene scene = lamp.scene();
      visibility::SampleRequest request;
      tests::reshape(scene.lights[0], kind, request, lamp.random(), 40);
      const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
      const std::optional<visibility::Light> light = tests::light_with_area(scene, floats.origin, request);
      refused += light ? 0 : 1;
      if (!light) continue;
      const visibility::ViewSamples samples = tests::hostile_samples(floats, lamp.random(), 5, 5);
      const auto masks =
          tests::unless_too_far_apart(floats, *light, [&] { return tests::run(*method, floats, *light, samples); });
      refused += masks ? 0 : 1;
      if (!masks) continue;
      EXPECT_TRUE(equals_truth(floats, *light, samples, *masks, &counts))
          << name_of(hostility) << " seed " << seed << " under " << kind;
    }
    EXPECT_GT(counts.visible, counts.pairs / 20);
    EXPECT_GT(counts.blocked, counts.pairs / 20);
    EXPECT_LE(refused, count / 100);
  }
};
TEST_P(PointLamps, EveryPairIsTheExactDecision) {
  look(0, std::get<2>(GetParam()).on_device() ? 16 : 40);
}
TEST_P(PointLamps, ThousandsFull) {
  for (std::uint32_t first = 1000; first < 11'000 && !HasFailure(); first += 1000) look(first, 1000);
}
INSTANTIATE_TEST_SUITE_P(Under, PointLamps,
                         testing::Combine(testing::ValuesIn(tests::kHostilities),
                                          testing::ValuesIn(tests::kPointLights), testing::ValuesIn(kEngines)),
                         [](const auto& it) {
                           return fmt::format("{}_{}_{}", std::get<2>(it.param).name, name_of(std::get<1>(it.param)),
                                              name_of(std::get<0>(it.param)));
                         });

class PointCounts : public tests::DeviceTest,
                    public testing::WithParamInterface<std::tuple<PointLight, tests::MaskMethod>> {};

/// Tiles that are not full, rows with different numbers of tiles, masks that end within a word; any number of threads
/// and any tiles of the picture.
TEST_P(PointCounts, AnyNumberOfLightSamples) {
  std::mt19937 random(7);
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  std::vector<tests::Corners> soup;
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&] { return glm::dvec3(real(random), 1 + 0.9 * real(random), real(random)); };
  for (int i = 0; i < 40; ++i) soup.push_back({point(), point(), point()});
  tests::add_object(scene, "soup", soup);
  scene.lights.push_back(tests::rectangle_light({0.2, 3, 0.1}, {1, 0.2, 0}, {0, -0.1, 0.8}));
  scene.cameras.push_back(tests::camera({0, 2, 6}, {0, 0.5, 0}));
  const auto& [kind, engine] = GetParam();
  const auto method = engine.make(device(), {});
  for (const std::uint32_t count : {1U, 2U, 15U, 16U, 17U, 31U, 33U, 100U, 255U, 257U, 1000U, 4095U, 4096U}) {
    scenes::Scene its = scene;
    visibility::SampleRequest request;
    tests::reshape(its.lights[0], kind, request, random, 1);
    request.count = std::max(request.count, count);
    const tests::Stage stage(its, 40, 30, request);
    const tests::Masks masks = tests::run(*method, stage);
    PairCounts counts;
    const std::size_t step = 1 + stage.light.sample_count() / 32;
    EXPECT_TRUE(equals_truth(stage.floats, stage.light, stage.samples, masks, &counts, step)) << count;
    EXPECT_TRUE(count < 8 || counts.blocked > 0) << count;
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const tests::Masks again = tests::run(*method, stage, 7);
    EXPECT_EQ(masks.words, again.words) << count;
    EXPECT_EQ(masks.visibility, again.visibility) << count;
  }
}
/// Outlines made of edges shorter than a tile, as in dense meshes. Some outlines pass outside all light samples: in a
/// corner of the rectangle around a disk, where segments to tiles pass. The reference is another method that promises
/// every bit.
TEST_P(PointCounts, ShortEdges) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> real(-1, 1);
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}));
  std::vector<tests::Corners> soup;
  for (int fan = 0; fan < 8; ++fan) {
    constexpr int kEdges = 200;
    const glm::dvec3 middle(0.8 * real(random), 1 + 0.5 * real(random), 0.8 * real(random));
    const auto rim = [&](int i) {
      const double angle = 2 * std::numbers::pi * i / kEdges, radius = 0.25 + 0.05 * std::cos(7 * angle + fan);
      return middle + radius * glm::dvec3(std::cos(angle), 0.2 * std::sin(angle), std::sin(angle));
    };
    for (int i = 0; i < kEdges; ++i) soup.push_back({middle, rim(i), rim(i + 1)});
  }
  tests::add_object(scene, "fans", soup);
  scene.lights.push_back(tests::rectangle_light({0.2, 3, 0.1}, {1, 0.2, 0}, {0, -0.1, 0.8}));
  scene.cameras.push_back(tests::camera({0, 2.5, 4}, {0, 0, 0}));
  const auto& [kind, engine] = GetParam();
  visibility::SampleRequest request;
  tests::reshape(scene.lights[0], kind, request, random, 1);
  request.count = std::max(request.count, 4096U);
  const tests::Stage stage(scene, 64, 48, request);
  const tests::Masks masks = tests::run(*engine.make(device(), {}), stage),
                     others = tests::run(*tests::kNativeViewSample.make(device(), {}), stage);
  std::size_t partly = 0, differing = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const std::uint32_t count = masks.visible_count(i);
    partly += count > 0 && count < stage.light.sample_count() ? 1 : 0;
  }
  for (std::size_t i = 0; i < masks.words.size(); ++i) differing += masks.words[i] != others.words[i] ? 1 : 0;
  EXPECT_EQ(differing, 0U) << "words of masks";
  EXPECT_GT(partly, 500U);
}
INSTANTIATE_TEST_SUITE_P(Under, PointCounts,
                         testing::Combine(testing::ValuesIn(tests::kPointLights), testing::ValuesIn(kEngines)),
                         [](const auto& it) {
                           return fmt::format("{}_{}", std::get<1>(it.param).name, name_of(std::get<0>(it.param)));
                         });

}  // namespace
}  // namespace penumbra
