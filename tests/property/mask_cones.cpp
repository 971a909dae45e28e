// SPDX-License-Identifier: Apache-2.0
// Tests masks under spheres and suns, whose light points differ between view samples, with triangles that touch these
// points exactly: every bit of the methods for such lights is the exact decision on these points, without tolerance.

#include "tests/agreement/cracked_ball.hpp"
#include "tests/agreement/mask_methods.hpp"
#include "tests/property/lattice_truth.hpp"
#include "visibility/receivers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace penumbra {
namespace {

using tests::PairCounts;

constexpr std::array kSamples{
    visibility::SampleRequest{9, 0, 0, visibility::SamplePattern::grid, 0},
    visibility::SampleRequest{16, 0, 0, visibility::SamplePattern::rows, 0},
    visibility::SampleRequest{23, 0, 0, visibility::SamplePattern::sobol, 3},
    visibility::SampleRequest{1, 0, 0, visibility::SamplePattern::grid, 0},
};

scenes::LightShape sphere_of(tests::LatticeSoup& soup, int range) {
  glm::dvec3 center = soup.point();
  if (soup.below(2) == 0) center.y = range + 1.0 + soup.below(3);
  static constexpr std::array kRadii{0.25, 0.5, 1.0, 2.0, 0x1p-10};
  return scenes::Sphere{center, kRadii[soup.below(kRadii.size())]};
}

scenes::LightShape sun_of(tests::LatticeSoup& soup, int) {
  glm::dvec3 direction = soup.point();
  if (direction == glm::dvec3(0)) direction.y = -1;
  static constexpr std::array kAngles{0.53, 0.0, 30.0, 90.0, 170.0, 1e-5, 179.9, 179.98};
  return scenes::Sun{direction, kAngles[soup.below(kAngles.size())]};
}

struct ConeRun {
  scenes::LightShape (*shape)(tests::LatticeSoup&, int);
  int range;
  std::uint32_t first, count;
};

PairCounts expect_cone_truth(visibility::Method& method, const ConeRun& run) {
  PairCounts counts;
  for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
    const std::uint32_t seed = i + 1000 * static_cast<std::uint32_t>(run.range);
    tests::LatticeSoup soup(seed, run.range);
    visibility::SampleRequest request;
    scenes::Scene scene = tests::lattice_scene(soup, request);
    scene.lights[0].shape = run.shape(soup, run.range);
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const visibility::Light light = visibility::make_light(scene, 0, floats.origin, kSamples[i % kSamples.size()]);
    const visibility::ViewSamples samples = tests::all_samples(scene, floats, soup.random());
    const tests::Masks masks = tests::run(method, floats, light, samples);
    EXPECT_TRUE(tests::equals_truth(floats, light, samples, masks, &counts))
        << "seed " << seed << " range " << run.range;
  }
  return counts;
}

using Shape = scenes::LightShape (*)(tests::LatticeSoup&, int);
class ConeLattices : public tests::DeviceTest,
                     public testing::WithParamInterface<std::tuple<int, Shape, tests::MaskMethod>> {
 protected:
  static PairCounts look(std::uint32_t first, std::uint32_t count) {
    const auto method = std::get<2>(GetParam()).make(device(), {});
    return expect_cone_truth(*method, {std::get<1>(GetParam()), std::get<0>(GetParam()), first, count});
  }
  static void expect_all_kinds(const PairCounts& counts) {
    EXPECT_GT(counts.visible, counts.pairs / 20);
    EXPECT_GT(counts.blocked, counts.pairs / 20);
    EXPECT_GT(counts.horizon, counts.pairs / 20);
    EXPECT_GT(counts.zero, counts.pairs / 1000);
  }
};

TEST_P(ConeLattices, EveryPairIsTheExactDecision) {
  expect_all_kinds(look(0, 60));
}
/// Tests 60,000 soups for each kind of light and each method.
TEST_P(ConeLattices, TensOfThousandsFull) {
  PairCounts counts;
  for (std::uint32_t done = 0; done < 20'000 && !HasFailure(); done += 1000) {
    counts += look(1000 + done, 1000);
    fmt::print("{}, range {}: {} soups, {} pairs, {} of them by a zero\n", std::get<2>(GetParam()).name,
               std::get<0>(GetParam()), done + 1000, counts.pairs, counts.zero);
    std::fflush(stdout);
  }
  expect_all_kinds(counts);
}
INSTANTIATE_TEST_SUITE_P(Lights, ConeLattices,
                         testing::Combine(testing::Values(1, 2, 4), testing::Values(&sphere_of, &sun_of),
                                          testing::ValuesIn(tests::kConeMethods)),
                         [](const auto& it) {
                           const bool sphere = std::get<1>(it.param) == &sphere_of;
                           return fmt::format("{}_{}_{}", std::get<2>(it.param).name, sphere ? "spheres" : "suns",
                                              std::get<0>(it.param));
                         });

/// Triangles near a light point of a sphere, with an edge through the point up to float rounding, under a small light
/// far from the origin: rounding of the point is the largest error there. Prints the share of its bound that is used.
class AimedSpheres : public tests::DeviceTest, public testing::WithParamInterface<tests::MaskMethod> {
 protected:
  /// With `in_disk`, triangles go through the light point itself and lie, up to a hundredth, in the disk that the view
  /// sample sees.
  static void run(visibility::Method& method, bool in_disk);
};

void AimedSpheres::run(visibility::Method& method, bool in_disk) {
  constexpr double kPlantedCut = 0.01;  // the factor in tests/planted_faults
  PairCounts counts;
  double used = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto vector = [&] { return glm::dvec3(real(random), real(random), real(random)); };
    scenes::Scene scene;
    // Keeps the origin of scene floats at zero, whatever else is added.
    scenes::Object& anchor =
        tests::add_object(scene, "anchor", {{glm::dvec3(-1024), glm::dvec3(1024, 1024, -1024), glm::dvec3(1024)}});
    anchor.casts_shadow = anchor.receives_shadow = false;
    const glm::dvec3 middle = glm::dvec3(700) + 200.0 * vector();
    tests::add_object(scene, "floor", tests::quad(middle, {1, 0.1, 0}, {0, 0.2, -1}));
    scene.lights.push_back(tests::rectangle_light(middle, {1, 0, 0}, {0, 0, 1}));
    scene.lights[0].shape = scenes::Sphere{middle + glm::dvec3(0, 4, 0) + vector(), 0.25};
    const visibility::SceneFloats floor = visibility::make_scene_floats(scene);
    ASSERT_EQ(floor.origin, glm::dvec3(0));
    const visibility::Light light = visibility::make_light(scene, 0, floor.origin, kSamples[1]);
    const visibility::ViewSamples samples = tests::samples_on_triangles(floor, 8, 8, random, 1U);
    const double reach =
        std::max({std::abs(light.center.x), std::abs(light.center.y), std::abs(light.center.z)}) + 0.25;
    std::vector<tests::Corners> casters;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!visibility::is_receiver(floor, light, samples, i)) continue;
      const glm::vec3& p = samples.p[i];
      std::vector<glm::vec3> points(light.sample_count());
      visibility::light_points_for(light, p, points.data());
      const std::size_t j = random() % points.size();
      const visibility::LightFrame disk = visibility::light_frame_from(light, p);
      const glm::dvec3 place = disk.center + light.coordinates[j].x * disk.u + light.coordinates[j].y * disk.v;
      used = std::max(used, glm::length(glm::dvec3(points[j]) - place) / (2 * 0x1p-24 * reach));
      const double share = in_disk ? 1 : 0.6 + 0.3 * real(random);
      const glm::dvec3 at = glm::dvec3(p) + share * (glm::dvec3(points[j]) - glm::dvec3(p));
      // Casters are nearly flat in a disk, so that much of a caster is within rounding of the disk's plane.
      const auto axis = [&] {
        const glm::dvec3 x = vector() + 0x1p-30, n = glm::normalize(glm::cross(disk.u, disk.v));
        return glm::normalize(in_disk ? x - (1 - 0.02 * real(random)) * glm::dot(x, n) * n : x);
      };
      const glm::dvec3 e = axis(), f = axis();
      casters.push_back(in_disk ? tests::Corners{at - 0.1 * e - 0.1 * f, at + 0.15 * e, at + 0.15 * f}
                                : tests::Corners{at - 0.1 * e, at + 0.15 * e, at + 0.1 * f});
    }
    tests::add_object(scene, "casters", casters);
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const tests::Masks masks = tests::run(method, floats, light, samples);
    EXPECT_TRUE(tests::equals_truth(floats, light, samples, masks, &counts)) << "seed " << seed;
  }
  fmt::print("{} pairs, {} visible, {} blocked; up to {:.1f} % of the bound is used\n", counts.pairs, counts.visible,
             counts.blocked, 100 * used);
  EXPECT_LT(used, 1);
  EXPECT_GT(used, 10 * kPlantedCut);
  EXPECT_GT(counts.visible, counts.pairs / 20);
  EXPECT_GT(counts.blocked, counts.pairs / 20);
}

TEST_P(AimedSpheres, EveryPairIsTheExactDecision) {
  run(*GetParam().make(device(), {}), false);
}
TEST_P(AimedSpheres, EveryPairOfTheDiskIsTheExactDecision) {
  run(*GetParam().make(device(), {}), true);
}

/// A sphere light that contains a ball of many triangles, with cracks: bits are exact, and few pairs are left to exact
/// predicates.
TEST_P(AimedSpheres, FewPairsAreOpenWhereASphereHoldsCasters) {
  const auto method = GetParam().make(device(), {});
  PairCounts counts;
  std::uint64_t open = 0;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    scenes::Scene scene;
    scenes::Object& anchor =
        tests::add_object(scene, "anchor", {{glm::dvec3(-8), glm::dvec3(8, 8, -8), glm::dvec3(8)}});
    anchor.casts_shadow = anchor.receives_shadow = false;
    tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {2, 0.1, 0}, {0, 0.2, -2}));
    const visibility::SceneFloats floor = visibility::make_scene_floats(scene);
    const visibility::ViewSamples samples = tests::samples_on_triangles(floor, 12, 12, random, 1U);
    scene.lights.push_back(tests::rectangle_light({0, 4, 0}, {1, 0, 0}, {0, 0, 1}));
    scene.lights[0].shape = scenes::Sphere{{0.2 * real(random), 2.5, 0.2 * real(random)}, 1.2};
    const glm::dvec3 middle(0.5 * real(random), 1.6 + 0.4 * real(random), 0.5 * real(random));
    tests::add_object(scene, "ball", tests::cracked_ball(middle, 0.6, random));
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    ASSERT_EQ(floats.origin, floor.origin);
    const visibility::Light light = visibility::make_light(scene, 0, floats.origin, kSamples[seed % 3]);
    const tests::Masks masks = tests::run(*method, floats, light, samples);
    EXPECT_TRUE(tests::equals_truth(floats, light, samples, masks, &counts)) << "seed " << seed;
    open += method->counters().at("openPairs");
  }
  fmt::print("{} pairs, {} visible, {} blocked, {} open\n", counts.pairs, counts.visible, counts.blocked, open);
  EXPECT_GT(counts.visible, counts.pairs / 20);
  EXPECT_GT(counts.blocked, counts.pairs / 20);
  // The other methods leave all pairs of such view samples to exact predicates.
  if (GetParam().name == std::string("native_edge_scatter")) {
    EXPECT_LT(open, counts.pairs / 50);
  }
}
INSTANTIATE_TEST_SUITE_P(Of, AimedSpheres, testing::ValuesIn(tests::kConeMethods),
                         [](const auto& it) { return std::string(it.param.name); });

/// The message about a wrong bit gives the light point: on the disk that p sees of a sphere, or as the direction of a
/// sun.
TEST(WrongBits, AreToldWithTheirLightPoints) {
  for (const scenes::LightShape& shape :
       {scenes::LightShape(scenes::Sphere{{0, 4, 0}, 0.5}), scenes::LightShape(scenes::Sun{{0, -1, 0}, 10})}) {
    scenes::Scene scene;
    tests::add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
    scene.lights.push_back(tests::ceiling_light(4, 0.5));
    scene.lights[0].shape = shape;
    scene.cameras.push_back(tests::camera({0, 3, 0.5}, {0, 0, 0}, 30));
    const tests::Stage stage(scene, 2, 2, tests::light_samples(4));
    tests::Masks dark;
    dark.words_per_pixel = 1;
    dark.words.resize(4);
    dark.visibility.resize(4);
    const testing::AssertionResult told = tests::equals_truth(stage.floats, stage.light, stage.samples, dark);
    std::vector<glm::vec3> points(stage.light.sample_count());
    visibility::light_points_for(stage.light, stage.samples.p[0], points.data());
    EXPECT_FALSE(told);
    EXPECT_NE(std::string(told.message()).find("; l " + tests::text_of(points[0]) + ";"), std::string::npos)
        << told.message();
  }
}

}  // namespace
}  // namespace penumbra
