// SPDX-License-Identifier: Apache-2.0
// Tests the mask methods on lattices, where nothing is in general position: every pair equals the exact decision,
// without tolerance.

#include "tests/agreement/volumes/light_span.hpp"
#include "tests/agreement/mask_methods.hpp"
#include "tests/property/lattice_truth.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace penumbra {
namespace {

using tests::PairCounts;
using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

/// Puts the origin of the scene floats at zero, so that tiny numbers are not rounded.
void anchor(scenes::Scene& scene) {
  tests::add_object(scene, "anchor", {{glm::dvec3(-4), glm::dvec3(4, 4, -4), glm::dvec3(4)}}).casts_shadow = false;
}

class HardScenes : public tests::DeviceTest, public testing::WithParamInterface<tests::MaskMethod> {};

class LatticeSoups : public tests::DeviceTest, public testing::WithParamInterface<std::tuple<int, tests::MaskMethod>> {
 protected:
  static tests::MethodsByLayout methods_of(const tests::MaskMethod& under_test) {
    return tests::MethodsByLayout([&under_test] { return under_test.make(device(), {}); });
  }
};

TEST_P(LatticeSoups, EveryPairIsTheExactDecision) {
  const auto [range, under_test] = GetParam();
  tests::MethodsByLayout methods = methods_of(under_test);
  const PairCounts counts = tests::expect_lattice_truth(methods, {range, 60, under_test.any_light});
  tests::expect_all_kinds(counts);
  EXPECT_GT(counts.behind, counts.pairs / 100);
}

/// The device runs without the validation layer, which takes most of the time and reports nothing here that it does not
/// report about the sixty soups of the quick test.
class LatticeSoupsFull : public testing::TestWithParam<std::tuple<int, tests::MaskMethod>> {};

/// Tests 60,000 soups for each engine of each method.
TEST_P(LatticeSoupsFull, EveryPairIsTheExactDecision) {
  const auto [range, under_test] = GetParam();
  const render::Device device(render::DeviceOptions{});
  tests::MethodsByLayout methods([&make = under_test.make, &device] { return make(device, {}); });
  const PairCounts counts =
      tests::expect_lattice_truth_by_thousands(methods, {range, 20'000, under_test.any_light, 1000}, under_test.name);
  tests::expect_all_kinds(counts);
}

/// Cases found among tens of thousands of soups: an outline along the light's left side; p inside another triangle
/// within rounding; an edge at p's own height; light samples stored off the light's plane, which a triangle touches.
TEST_P(HardScenes, LatticeSoupsThatWereWrong) {
  tests::MethodsByLayout methods([&] { return GetParam().make(device(), {}); });
  static constexpr std::pair<int, std::uint32_t> kSoups[] = {{1, 335},   {1, 788},   {1, 873},  {1, 10790},
                                                             {2, 271},   {1, 4379},  {1, 9538}, {1, 11328},
                                                             {1, 12726}, {1, 14607}, {2, 7626}};
  for (const auto& [range, first] : kSoups)
    tests::expect_lattice_truth(methods, {range, 1, GetParam().any_light, first});
}

std::string name_of_soups(const testing::TestParamInfo<std::tuple<int, tests::MaskMethod>>& info) {
  return fmt::format("{}_{}", std::get<1>(info.param).name, std::get<0>(info.param));
}
INSTANTIATE_TEST_SUITE_P(Range, LatticeSoups,
                         testing::Combine(testing::Values(1, 2, 4), testing::ValuesIn(tests::kMaskMethods)),
                         name_of_soups);
INSTANTIATE_TEST_SUITE_P(Range, LatticeSoupsFull,
                         testing::Combine(testing::Values(1, 2, 4), testing::ValuesIn(tests::kMaskMethods)),
                         name_of_soups);

/// A method may refuse a light that float32 cannot represent together with the scene; it must not give wrong answers.
std::optional<tests::Masks> run_or_refuse(visibility::Method& method, const SceneFloats& floats, const Light& light,
                                          const ViewSamples& samples) {
  return tests::unless_too_far_apart(floats, light, [&] { return tests::run(method, floats, light, samples); });
}

/// Needles so thin that a double cross product of their edges is mostly rounding error, in scenes of mixed magnitudes:
/// as carriers and as occluders, far from the origin and at it.
TEST_P(HardScenes, NeedlesOfMixedMagnitudes) {
  const auto method = GetParam().make(device(), {});
  PairCounts counts;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&] { return glm::dvec3(real(random), real(random), real(random)); };
    scenes::Scene scene;
    anchor(scene);
    std::vector<tests::Corners> needles;
    for (int i = 0; i < 24; ++i) {
      const glm::vec3 b = glm::vec3(point());
      const glm::dvec3 a = point() * std::ldexp(1.0, -static_cast<int>(random() % 60));
      switch (random() % 3) {
        case 0:
          needles.push_back({a, b, 2.0F * b});
          break;  // corners nearly on a line through zero
        case 1:
          needles.push_back({b, glm::dvec3(b) + a, -point()});
          break;  // one edge is short
        default:
          needles.push_back({b, -b, a});
          break;  // flat: the third corner is near the middle
      }
    }
    tests::add_object(scene, "needles", needles);
    scene.lights.push_back(tests::rectangle_light(glm::dvec3(0.3, 1.5, 0.2) + point(), {0.5, 0.1, 0}, {0, 0.1, 0.6}));
    scene.lights[0].two_sided = seed % 2 == 0;
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, {64, 0, 0, visibility::SamplePattern::rows, 0});
    const ViewSamples samples = tests::samples_on_triangles(floats, 8, 8, random);
    const tests::Masks masks = tests::run(*method, floats, light, samples);
    EXPECT_TRUE(equals_truth(floats, light, samples, masks, &counts)) << "seed " << seed;
  }
  EXPECT_GT(counts.visible, counts.pairs / 10);
  EXPECT_GT(counts.blocked, counts.pairs / 1000);
}

/// Coordinates over forty powers of two: a cluster of tiny triangles inside large ones, with the light near either of
/// them.
TEST_P(HardScenes, MagnitudesFarApart) {
  const auto method = GetParam().make(device(), {});
  PairCounts counts;
  std::uint32_t refused = 0, without_area = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
    const double small = std::ldexp(1.0, -static_cast<int>(random() % 40)), light_size = seed % 2 == 0 ? 1 : small;
    scenes::Scene scene;
    anchor(scene);
    std::vector<tests::Corners> soup;
    for (int i = 0; i < 24; ++i) {
      const double size = i % 3 == 0 ? 1 : small;
      soup.push_back({point(size), point(size), point(size)});
    }
    tests::add_object(scene, "soup", soup);
    scene.lights.push_back(tests::rectangle_light(point(light_size) + glm::dvec3(0, 2 * light_size, 0),
                                                  light_size * glm::dvec3(0.5, 0.1, 0),
                                                  light_size * glm::dvec3(0, 0.1, 0.6)));
    scene.lights[0].two_sided = seed % 3 == 0;
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const auto pattern =
        seed % 4 < 2 || !GetParam().any_light ? visibility::SamplePattern::rows : visibility::SamplePattern::jittered;
    const std::optional<Light> light = tests::light_with_area(scene, floats.origin, {64, 0, 0, pattern, 0});
    without_area += light ? 0 : 1;
    if (!light) continue;
    const ViewSamples samples = tests::samples_on_triangles(floats, 8, 8, random);
    const std::optional<tests::Masks> masks = run_or_refuse(*method, floats, *light, samples);
    refused += masks ? 0 : 1;
    if (!masks) continue;
    EXPECT_TRUE(equals_truth(floats, *light, samples, *masks, &counts)) << "seed " << seed << " small " << small;
  }
  fmt::print("{} lights refused, {} without an area\n", refused, without_area);
  EXPECT_GT(refused, 0U);
  EXPECT_LT(refused + without_area, 20U);
  EXPECT_GT(counts.visible, counts.pairs / 20);
  EXPECT_GT(counts.blocked, counts.pairs / 100);
}

/// A light as large and as far away as the sun: compared with it the scene is a speck.
TEST_P(HardScenes, LightsFarAway) {
  const auto method = GetParam().make(device(), {});
  PairCounts counts;
  for (int exponent = 0; exponent <= 60; exponent += 2) {
    std::mt19937 random(static_cast<std::uint32_t>(exponent));
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
    scenes::Scene scene;
    tests::add_object(scene, "floor", tests::quad({0, -1.37, 0}, {3.1, 0.1, 0}, {0, 0.2, -2.9}));
    std::vector<tests::Corners> soup;
    for (int i = 0; i < 24; ++i) soup.push_back({point(1), point(1), point(1)});
    tests::add_object(scene, "soup", soup);
    const double distance = 4 * std::ldexp(1.0, exponent);
    scene.lights.push_back(tests::rectangle_light(
        distance * glm::dvec3(0.3, 1, 0.2), distance * glm::dvec3(0.2, 0.05, 0), distance * glm::dvec3(0, 0.05, 0.2)));
    const SceneFloats floats = visibility::make_scene_floats(scene);
    for (const auto pattern : {visibility::SamplePattern::rows, visibility::SamplePattern::sobol}) {
      if (!GetParam().any_light && pattern != visibility::SamplePattern::rows) continue;
      const Light light = visibility::make_light(scene, 0, floats.origin, {64, 0, 0, pattern, 0});
      const ViewSamples samples = tests::samples_on_triangles(floats, 8, 8, random);
      const std::optional<tests::Masks> masks = run_or_refuse(*method, floats, light, samples);
      EXPECT_TRUE(masks || exponent > 24) << "refused: distance 2^" << exponent;
      if (!masks) continue;
      EXPECT_TRUE(equals_truth(floats, light, samples, *masks, &counts))
          << "distance 2^" << exponent << " " << name_of(pattern);
    }
  }
  EXPECT_GT(counts.visible, counts.pairs / 10);
  EXPECT_GT(counts.blocked, counts.pairs / 10);
}

/// An empty picture, and one in which nothing casts shadow.
TEST_P(HardScenes, NothingToHideTheLight) {
  for (const bool empty_view : {false, true}) {
    scenes::Scene scene;
    tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4})).casts_shadow = false;
    scene.lights.push_back(tests::ceiling_light(3, 1));
    scene.cameras.push_back(tests::camera({0, 2, 6}, empty_view ? glm::dvec3(0, 9, 9) : glm::dvec3(0)));
    const tests::Stage stage(scene, 17, 11);
    const tests::Masks masks = tests::run(*GetParam().make(device(), {}), stage.floats, stage.light, stage.samples);
    for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel)
      ASSERT_EQ(masks.visible_count(pixel), 256U) << pixel;
  }
}

TEST_P(HardScenes, SphereLightsAreRefusedOnTheDevice) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  scene.lights.emplace_back();
  scene.lights[0].shape = scenes::Sphere{{0, 3, 0}, 1};
  scene.cameras.push_back(tests::camera({0, 2, 6}, {0, 0, 0}));
  const tests::Stage stage(scene, 8, 8);
  const auto run = [&] { return tests::run(*GetParam().make(device(), {}), stage.floats, stage.light, stage.samples); };
  if (GetParam().on_device()) {
    EXPECT_THROW(run(), InputError);
  } else {
    EXPECT_NO_THROW(run());
  }
  EXPECT_THROW(GetParam().make(device(), {{"bias", "0.1"}}), UsageError);
}

INSTANTIATE_TEST_SUITE_P(By, HardScenes, testing::ValuesIn(tests::kMaskMethods),
                         [](const auto& by) { return by.param.name; });

}  // namespace
}  // namespace penumbra
