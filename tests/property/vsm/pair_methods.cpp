// SPDX-License-Identifier: Apache-2.0
// Compares methods that decide pairs triangle by triangle with the exact decision, without tolerance: lattice soups
// under every kind of light that they support, lamps where rounding matters most, flawed meshes, shipped scenes.

#include "tests/agreement/differences.hpp"
#include "tests/agreement/hostile_lamps.hpp"
#include "tests/agreement/point_lights.hpp"
#include "tests/agreement/volumes/light_span.hpp"
#include "tests/property/lattice_truth.hpp"
#include "tests/unit/mesh/shuffled.hpp"
#include "tests/unit/shipped_scene.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "vsm/methods.hpp"
#include "vsm/view_sample_lists.hpp"

#include <optional>

namespace penumbra {
namespace {

using tests::PairCounts;
using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

struct PairMethodUnderTest {
  const char* name;
  std::unique_ptr<visibility::Method> (*make)(const visibility::MethodOptions&);
  friend std::ostream& operator<<(std::ostream& out, const PairMethodUnderTest& method) { return out << method.name; }
};
/// Makes view-sample with variant=sintorn, which needs no device.
std::unique_ptr<visibility::Method> make_sintorn(const visibility::MethodOptions& options) {
  visibility::MethodOptions all = options;
  all["variant"] = "sintorn";
  return vsm::make_view_sample_lists(vsm::view_sample_description(all));
}
/// Makes a method in which every plane is a separate receiver and the map is coarse, so that much is left open.
std::unique_ptr<visibility::Method> make_planes(const visibility::MethodOptions& options) {
  visibility::MethodOptions all{{"fewest", "1"}, {"map", "9"}};
  all.insert(options.begin(), options.end());
  return vsm::make_view_sample_planar(all);
}
constexpr std::array kPairMethods{PairMethodUnderTest{"hierarchical_penumbra", vsm::make_hierarchical_penumbra},
                                  PairMethodUnderTest{"sintorn", make_sintorn},
                                  PairMethodUnderTest{"planar", vsm::make_view_sample_planar},
                                  PairMethodUnderTest{"planes", make_planes}};

class PairMethods : public testing::TestWithParam<PairMethodUnderTest> {
 protected:
  /// Checks a lattice soup under, in turn, a rectangle with samples in rows, one with samples anywhere, a light of
  /// point_lights, or a sun.
  static PairCounts look_at_soup(std::uint32_t seed, int range) {
    tests::LatticeSoup soup(seed, range);
    visibility::SampleRequest request;
    scenes::Scene scene = tests::lattice_scene(soup, request);
    if (seed % 4 == 2) {
      tests::reshape(scene.lights[0], tests::kPointLights.at(soup.below(tests::kPointLights.size())), request,
                     soup.random(), 70);
    }
    if (seed % 4 == 3) {
      glm::dvec3 direction = soup.point();
      if (direction == glm::dvec3(0)) direction = {0, -1, 0};
      scene.lights[0].shape = scenes::Sun{direction, std::array{0.0, 1.0, 53.0, 120.0}.at(soup.below(4))};
      request.count = 1 + soup.below(70);
    }
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light made = visibility::make_light(scene, 0, floats.origin, request);
    const Light light = seed % 4 == 1 ? tests::scattered(made, seed % 8 == 1) : made;
    const ViewSamples samples = tests::all_samples(scene, floats, soup.random());
    const tests::Masks masks = tests::run(*GetParam().make({}), floats, light, samples, seed % 5 == 0 ? 3 : 0);
    PairCounts counts;
    EXPECT_TRUE(equals_truth(floats, light, samples, masks, &counts)) << "seed " << seed << " range " << range;
    return counts;
  }
  static void look_at_soups(std::uint32_t first, std::uint32_t count) {
    PairCounts counts;
    for (std::uint32_t seed = first; seed < first + count && !HasFailure(); ++seed)
      counts += look_at_soup(seed, 1 << seed % 3);
    fmt::print("{}: {} soups, {} pairs, {} visible, {} blocked, {} by a zero\n", GetParam().name, count, counts.pairs,
               counts.visible, counts.blocked, counts.zero);
    tests::expect_all_kinds(counts);
  }

  static void look_at_lamps(tests::Hostility hostility, std::uint32_t first, std::uint32_t count) {
    PairCounts counts;
    for (std::uint32_t seed = first; seed < first + count && !HasFailure(); ++seed) {
      tests::HostileLamp lamp(hostility, seed);
      const SceneFloats floats = visibility::make_scene_floats(lamp.scene());
      const std::optional<Light> rows =
          tests::light_with_area(lamp.scene(), floats.origin, {40, 0, 0, visibility::SamplePattern::rows, 0});
      if (!rows) continue;
      const Light light = seed % 2 == 0 ? *rows : tests::scattered(*rows, seed % 4 == 1);
      const ViewSamples samples = tests::hostile_samples(floats, lamp.random(), 5, 5);
      const tests::Masks masks = tests::run(*GetParam().make({}), floats, light, samples);
      EXPECT_TRUE(equals_truth(floats, light, samples, masks, &counts)) << name_of(hostility) << " seed " << seed;
    }
    fmt::print("{} {}: {} pairs, {} blocked\n", GetParam().name, name_of(hostility), counts.pairs, counts.blocked);
    EXPECT_GT(counts.visible, counts.pairs / 20);
    EXPECT_GT(counts.blocked, counts.pairs / 20);
  }

  /// Compares with the ray caster; where the two differ, the method must be right.
  static tests::Differences look_at(const tests::Stage& stage) {
    const tests::Masks mapped = tests::run(*GetParam().make({}), stage.floats, stage.light, stage.samples),
                       traced = tests::run(*reference::make_ray_traced({}), stage.floats, stage.light, stage.samples);
    return tests::differences(stage.floats, stage.samples, stage.light, mapped, traced);
  }
};
using PairMethodsFull = PairMethods;

TEST_P(PairMethods, LatticeSoups) {
  look_at_soups(0, 120);
}
TEST_P(PairMethodsFull, SixtyThousandLatticeSoups) {
  for (std::uint32_t first = 1000; first < 61'000 && !HasFailure(); first += 5000) look_at_soups(first, 5000);
}
TEST_P(PairMethods, HostileLamps) {
  for (const tests::Hostility hostility : tests::kHostilities) look_at_lamps(hostility, 0, 30);
}
TEST_P(PairMethodsFull, ThousandsOfHostileLamps) {
  for (const tests::Hostility hostility : tests::kHostilities) look_at_lamps(hostility, 1000, 5000);
}

TEST_P(PairMethods, ShippedScenes) {
  for (const char* name : {"contact", "thin", "textured-light"}) {
    for (const auto pattern : {visibility::SamplePattern::rows, visibility::SamplePattern::sobol}) {
      const tests::Stage stage(tests::shipped_scene(name), 24, 18, {100, 0, 0, pattern, 1});
      const tests::Differences found = look_at(stage);
      EXPECT_EQ(found.judged, found.mapped_right) << name << ": " << found.first_wrong;
      EXPECT_GT(found.pairs, 0U) << name;
    }
  }
}

TEST_P(PairMethods, FlawedMeshes) {
  for (const char* defect : {"hole", "flipped-patch", "inside-out", "duplicate-face", "t-junction", "needle", "fin"}) {
    const tests::Stage stage(tests::with_a_floor(mesh::make_broken_mesh({{defect}, 2, {0, 1, 0}, 1}).soup), 32, 24);
    const tests::Differences found = look_at(stage);
    EXPECT_EQ(found.judged, found.mapped_right) << defect << ": " << found.first_wrong;
    EXPECT_GT(found.pairs, 0U) << defect;
  }
}

/// A square half way between a square light and the floor, parallel to both, with sides half as long as the light's. On
/// a light [−1, 1]², p sees it as the square [c − ½, c + ½]² with c = −2 p in half-sizes of the light. This gives the
/// counts of light samples on a grid.
TEST_P(PairMethods, ASquareHidesASquareOfLightSamples) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "square", tests::quad({0, 2, 0}, {0.25, 0, 0}, {0, 0, -0.25}));
  scene.lights.push_back(tests::ceiling_light(4, 1));
  scene.cameras.push_back(tests::camera({0.1, 1.6, 5}, {0, 0, 0}, 60));
  const tests::Stage stage(scene, 64, 48, {256, 16, 16, visibility::SamplePattern::grid, 0});
  const tests::Masks masks = tests::run(*GetParam().make({}), stage.floats, stage.light, stage.samples);
  std::size_t some = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0 || stage.floats.object[static_cast<std::size_t>(stage.samples.triangle[i])] != 0)
      continue;
    const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
    std::array<int, 2> hidden{};
    bool close = false;  // p is a float, off by at most 2⁻²⁴ · 4; so are the sides of its square
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double c = axis == 0 ? -p.x : -p.z;
      for (int k = 0; k < 16; ++k) {
        const double l = (k + 0.5) / 8 - 1;
        hidden[axis] += std::abs(l - c) < 0.5 ? 1 : 0;
        close = close || std::abs(std::abs(l - c) - 0.5) < 1e-6;
      }
    }
    if (close) continue;
    EXPECT_EQ(masks.visible_count(i), 256U - static_cast<std::uint32_t>(hidden[0] * hidden[1])) << "pixel " << i;
    some += hidden[0] * hidden[1] > 0 ? 1 : 0;
  }
  EXPECT_GT(some, 50U);
}

TEST_P(PairMethods, NeitherOrderNorWindingNorTilesChangeABit) {
  scenes::Scene scene = tests::with_a_floor(mesh::make_broken_mesh({{"fin", "hole"}, 3, {0, 1, 0}, 1}).soup);
  const tests::Stage stage(scene, 40, 30);
  const tests::Masks first = tests::run(*GetParam().make({}), stage.floats, stage.light, stage.samples);
  EXPECT_EQ(tests::run(*GetParam().make({}), stage.floats, stage.light, stage.samples, 7).words, first.words);
  std::mt19937 random(7);
  tests::shuffle_order(scene.soup, random);
  tests::shuffle_corners(scene.soup, random);
  const tests::Stage shuffled(scene, 40, 30);
  EXPECT_EQ(tests::run(*GetParam().make({}), shuffled.floats, shuffled.light, shuffled.samples).words, first.words);
}

TEST_P(PairMethods, SpheresAndUnknownOptionsAreRefused) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  scene.lights.emplace_back();
  scene.lights[0].shape = scenes::Sphere{{0, 3, 0}, 1};
  scene.cameras.push_back(tests::camera({0, 2, 6}, {0, 0, 0}));
  const tests::Stage stage(scene, 8, 8);
  EXPECT_THROW(tests::run(*GetParam().make({}), stage), InputError);
  EXPECT_THROW(GetParam().make({{"bias", "0.1"}}), UsageError);
}

const auto kName = [](const auto& it) { return std::string(it.param.name); };
INSTANTIATE_TEST_SUITE_P(Of, PairMethods, testing::ValuesIn(kPairMethods), kName);
INSTANTIATE_TEST_SUITE_P(Of, PairMethodsFull, testing::ValuesIn(kPairMethods), kName);

/// A square larger than the light has an umbra: boxes of pairs in it, and outside the penumbra, are decided as a whole.
TEST(HierarchicalPenumbra, BoxesDecideMostPairs) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4})).casts_shadow = false;
  tests::add_object(scene, "square", tests::quad({0, 1, 0}, {1, 0, 0}, {0, 0, -1}));
  scene.lights.push_back(tests::ceiling_light(4, 0.3));
  scene.cameras.push_back(tests::camera({0.1, 3, 5}, {0, 0, 0}, 60));
  const tests::Stage stage(scene, 96, 72);
  const auto method = vsm::make_hierarchical_penumbra({});
  tests::run(*method, stage.floats, stage.light, stage.samples);
  const auto counters = method->counters();
  const std::uint64_t all = stage.samples.size() * std::uint64_t{stage.light.sample_count()};
  EXPECT_GT(counters.at("pairsHiddenInBoxes"), all / 50);
  EXPECT_GT(counters.at("boxesBeside"), 0U);
  EXPECT_LT(counters.at("trianglesTried"), stage.samples.size() / 2);
  EXPECT_LT(counters.at("pairsByExactPredicates"), counters.at("pairsTried") / 100);
}

/// The published look-up is wrong near outlines, and less often with a finer map.
TEST(ViewSamplePlanar, FinerMapsAreLessWrong) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4})).casts_shadow = false;
  tests::add_object(scene, "ball", tests::sphere({0, 2, 0}, 0.7, 8));
  scene.lights.push_back(tests::ceiling_light(4, 1));
  scene.cameras.push_back(tests::camera({0.1, 3, 5}, {0, 0, 0}, 60));
  const tests::Stage stage(scene, 64, 48);
  const auto wrong_with = [&](const visibility::MethodOptions& options) {
    const tests::Masks masks =
        tests::run(*vsm::make_view_sample_planar(options), stage.floats, stage.light, stage.samples);
    const tests::Masks truth =
        tests::run(*vsm::make_hierarchical_penumbra({}), stage.floats, stage.light, stage.samples);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < truth.words.size(); ++i)
      wrong += static_cast<std::size_t>(std::popcount(masks.words[i] ^ truth.words[i]));
    return wrong;
  };
  const std::size_t coarse = wrong_with({{"lookup", "nearest"}, {"map", "16"}}),
                    usual = wrong_with({{"lookup", "nearest"}}),
                    fine = wrong_with({{"lookup", "nearest"}, {"map", "1024"}});
  fmt::print("wrong pairs with maps of 16, 128, 1024: {}, {}, {}\n", coarse, usual, fine);
  EXPECT_GT(coarse, 3 * usual);
  EXPECT_GT(usual, 3 * fine);
  EXPECT_GT(fine, 0U);
  EXPECT_EQ(wrong_with({}), 0U);
}

}  // namespace
}  // namespace penumbra
