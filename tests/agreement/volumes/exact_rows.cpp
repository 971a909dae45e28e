// SPDX-License-Identifier: Apache-2.0
// Compares edge-scatter with rows=exact with the exact areas; neither uses light samples.

#include "tests/agreement/volumes/exact_rows.hpp"
#include "tests/agreement/hostile_lamps.hpp"
#include "tests/agreement/lattice.hpp"
#include "tests/agreement/volumes/light_span.hpp"
#include "tests/agreement/panel.hpp"
#include "tests/agreement/volumes/soft_stage.hpp"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace penumbra::volumes {
namespace {

using tests::ExactRows;
using tests::SoftStage;
using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

constexpr double kTolerance = tests::kExactRowsTolerance;

class ExactRowsOnScenes : public ExactRows, public testing::WithParamInterface<const char*> {};

TEST_P(ExactRowsOnScenes, AreTheExactAreas) {
  const SoftStage stage(tests::shipped_scene(GetParam()), device(), 64, 64);
  Found found;
  compare(stage.floats, stage.light, stage.samples, kTolerance, found);
  fmt::print("{}: {} pixels, {} partly lit, {} unproven, off by {:.1e} at most, form factors by {:.1e}\n", GetParam(),
             found.pixels, found.partly, found.unproven, found.largest, found.largest_form_factor);
  EXPECT_EQ(found.wrong, 0U);
  EXPECT_GT(found.partly, 60U);
  EXPECT_LE(found.unproven, found.pixels / 500);
  EXPECT_EQ(found.wrong_form_factors, 0U);
}
INSTANTIATE_TEST_SUITE_P(Shipped, ExactRowsOnScenes,
                         testing::Values("broken", "bunny", "contact", "fusion", "parallel-square", "room",
                                         "self-shadow", "thin"),
                         [](const auto& it) {
                           std::string name = it.param;
                           std::erase(name, '-');
                           return name;
                         });

/// Everything coincides with something: triangles through lights, doubled triangles, p in other triangles' planes.
TEST_F(ExactRows, LatticeSoups) {
  Found found;
  for (const int range : {1, 2, 4}) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      tests::LatticeSoup soup(seed + 5000 * static_cast<std::uint32_t>(range), range);
      visibility::SampleRequest request;
      const scenes::Scene scene = lattice_scene(soup, request);
      const SceneFloats floats = visibility::make_scene_floats(scene);
      const Light light = visibility::make_light(scene, 0, floats.origin, request);
      const ViewSamples samples = tests::samples_on_triangles(floats, 8, 8, soup.random());
      SCOPED_TRACE(fmt::format("seed {} range {}", seed, range));
      const std::size_t before = found.wrong;
      compare(floats, light, samples, kTolerance, found);
      EXPECT_EQ(found.wrong, before);
    }
  }
  fmt::print("{} view samples, {} partly lit, {} unproven, off by {:.1e} at most, form factors by {:.1e}\n",
             found.pixels, found.partly, found.unproven, found.largest, found.largest_form_factor);
  EXPECT_GT(found.partly, found.pixels / 20);
}

/// An edge through the origin, and view samples so near to it that even in double the edge passes through them: only
/// exact predicates decide on which side it passes, and whether it is in front of the light.
TEST_F(ExactRows, EdgesThroughP) {
  Found found;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto vector = [&] { return glm::dvec3(glm::vec3(real(random), real(random), real(random))); };
    const auto scale = [&](std::uint32_t most) { return std::ldexp(1.0, -static_cast<int>(random() % most)); };
    scenes::Scene scene;
    // Keeps the origin of scene floats at zero, whatever else is added.
    scenes::Object& anchor =
        tests::add_object(scene, "anchor", {{glm::dvec3(-16), glm::dvec3(16, 16, -16), glm::dvec3(16)}});
    anchor.casts_shadow = anchor.receives_shadow = false;
    const glm::dvec3 u(1, 0.2 * real(random), 0.2 * real(random)), v(0.2 * real(random), 0.2 * real(random), -1);
    tests::add_object(scene, "floor", tests::quad({0, 0, 0}, u, v));
    const glm::dvec3 along = vector();
    tests::add_object(scene, "caster", {{scale(6) * along, -scale(6) * along, vector()}});
    scene.lights.push_back(tests::rectangle_light(glm::dvec3(0, 3, 0) + vector(), {1, 0, 0.1}, {-0.1, 0.2, 1}));
    const SceneFloats floats = visibility::make_scene_floats(scene);
    ASSERT_EQ(floats.origin, glm::dvec3(0));
    ViewSamples samples = tests::samples_on_triangles(floats, 4, 4, random, 1U);
    for (glm::vec3& p : samples.p) p = glm::vec3(0x1p-50 * scale(20) * vector());
    const Light light = visibility::make_light(scene, 0, floats.origin, {});
    SCOPED_TRACE(fmt::format("seed {}", seed));
    compare(floats, light, samples, kTolerance, found);
  }
  fmt::print("{} view samples, {} partly lit, {} unproven, off by {:.1e} at most\n", found.pixels, found.partly,
             found.unproven, found.largest);
  EXPECT_EQ(found.wrong, 0U);
  EXPECT_EQ(found.wrong_form_factors, 0U);
  EXPECT_GT(found.partly, found.pixels / 20);
  EXPECT_GT(found.unproven, found.pixels / 20);
}

/// Lamps for which the answer was once wrong: black where the light is visible, or off by a few millionths.
class ExactRowsOfLamps : public ExactRows, public testing::WithParamInterface<const char*> {};

TEST_P(ExactRowsOfLamps, AreTheExactAreas) {
  const scenes::Scene scene =
      scenes::read_scene(std::filesystem::path(PENUMBRA_TEST_LAMPS) / (std::string(GetParam()) + ".json"));
  const SoftStage stage(scene, device(), 24, 24);
  Found found;
  compare(stage.floats, stage.light, stage.samples, kTolerance, found);
  EXPECT_EQ(found.wrong, 0U);
  EXPECT_EQ(found.wrong_form_factors, 0U);
  EXPECT_GT(found.pixels, 50U);
}
INSTANTIATE_TEST_SUITE_P(Lamps, ExactRowsOfLamps,
                         testing::Values("panel-in-plane", "panel-as-light", "panel-larger", "panel-frame",
                                         "soup-and-panel-in-plane", "soup-and-panel-near-1", "soup-and-panel-near-2",
                                         "magnitudes-1", "magnitudes-2"),
                         [](const auto& it) {
                           std::string name = it.param;
                           std::erase(name, '-');
                           return name;
                         });

class LooksAtHostileLamps : public ExactRows {
 protected:
  static void look(tests::Hostility hostility, std::uint32_t first, std::uint32_t count) {
    Found found;
    std::uint32_t refused = 0;
    for (std::uint32_t seed = first; seed < first + count && found.wrong == 0; ++seed) {
      SCOPED_TRACE(fmt::format("{} seed {}", name_of(hostility), seed));
      tests::HostileLamp lamp(hostility, seed);
      const SceneFloats floats = visibility::make_scene_floats(lamp.scene());
      const std::optional<Light> light = tests::light_with_area(lamp.scene(), floats.origin, {});
      refused += light ? 0 : 1;
      if (!light) continue;
      const ViewSamples samples = tests::hostile_samples(floats, lamp.random(), 6, 8);
      const auto answer = tests::unless_too_far_apart(floats, *light, [&] {
        compare(floats, *light, samples, kTolerance, found);
        return true;
      });
      refused += answer ? 0 : 1;
    }
    EXPECT_LE(refused, count / 100);
    fmt::print("{}: {} lamps, {} refused, {} view samples, {} partly lit, {} unproven, off by {:.2e} at most\n",
               name_of(hostility), count, refused, found.pixels, found.partly, found.unproven, found.largest);
    EXPECT_EQ(found.wrong, 0U);
    EXPECT_GT(found.partly, found.pixels / 50);
    EXPECT_LT(found.unproven, found.pixels / 2);  // with panels, a third lies in the light's own plane
  }
};
class HostileLamps : public LooksAtHostileLamps, public testing::WithParamInterface<tests::Hostility> {};
TEST_P(HostileLamps, AreTheExactAreas) {
  look(GetParam(), 0, 150);
}
INSTANTIATE_TEST_SUITE_P(Kinds, HostileLamps, testing::ValuesIn(tests::kHostilities),
                         [](const auto& it) { return tests::name_of(it.param); });

/// A hundred thousand lamps of each kind, in ten parts, so that a stopped run can be continued.
class ManyHostileLamps : public LooksAtHostileLamps,
                         public testing::WithParamInterface<std::tuple<tests::Hostility, std::uint32_t>> {};
TEST_P(ManyHostileLamps, AreTheExactAreasFull) {
  const auto [hostility, part] = GetParam();
  look(hostility, 1000 + 10000 * part, 10000);
}
INSTANTIATE_TEST_SUITE_P(Kinds, ManyHostileLamps,
                         testing::Combine(testing::ValuesIn(tests::kHostilities), testing::Range(0u, 10u)),
                         [](const auto& it) {
                           return fmt::format("{}{}", tests::name_of(std::get<0>(it.param)), std::get<1>(it.param));
                         });

/// For a light that stands on the floor, V times the unshadowed integral is wrong, but form factors are right.
TEST_F(ExactRows, FormFactorsBesideALight) {
  const SoftStage stage(tests::things_before_a_panel(), device(), 96, 72);
  Found found;
  compare(stage.floats, stage.light, stage.samples, kTolerance, found);
  EXPECT_EQ(found.wrong, 0U);
  EXPECT_GT(found.partly, 400U);
  EXPECT_EQ(found.wrong_form_factors, 0U);
  EXPECT_LT(found.largest_form_factor, 1e-8);
}

/// Parallelograms, and two-sided lights.
TEST_F(ExactRows, OtherRectangles) {
  Found found;
  for (const double skew : {0.0, 0.3, -0.9}) {
    scenes::Scene scene = tests::shipped_scene("fusion");
    auto& light = std::get<scenes::Rectangle>(scene.lights[0].shape);
    light.half_v += skew * light.half_u;
    scene.lights[0].two_sided = true;
    if (skew == 0) std::swap(light.half_u, light.half_v);  // emits upward and, being two-sided, downward
    const SoftStage stage(scene, device(), 48, 48);
    compare(stage.floats, stage.light, stage.samples, kTolerance, found);
  }
  EXPECT_EQ(found.wrong, 0U);
  EXPECT_GT(found.partly, 300U);
}

/// A panel that reaches into a sphere: every view sample needs the exact area, also while the area's data are being
/// made on all cores. There are more threads than cores, and threads that wait take other work.
TEST_F(ExactRows, ManyThreadsAskForExactAreasAtOnce) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "panel", tests::quad({0.5, 2, 0}, {0.6, 0, 0}, {0, 0.1, -0.6}));
  std::vector<tests::Corners> aside;  // many more triangles, outside of the picture
  for (int i = 0; i < 40000; ++i) {
    const int column = i % 200, row = i / 200;
    const auto more = tests::quad({100 + 0.01 * column, 0.01 * row, 0}, {0.002, 0, 0}, {0, 0.002, 0.001});
    aside.insert(aside.end(), more.begin(), more.end());
  }
  tests::add_object(scene, "aside", aside);
  scene.lights.push_back({"bulb", scenes::Sphere{{0, 2, 0}, 0.5}, glm::dvec3(1)});
  scene.cameras.push_back(tests::camera({0, 1.5, 4}, {0, 0.3, 0}, 60));
  const SoftStage stage(scene, device(), 64, 64);
  const Answer expected = run(*make(), stage.floats, stage.light, stage.samples);
  const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 8);
  tbb::task_arena crowd(8);
  for (int round = 0; round < 20; ++round) {
    const Answer found = crowd.execute([&] { return run(*make(), stage.floats, stage.light, stage.samples); });
    EXPECT_EQ(found.shares, expected.shares);
    EXPECT_EQ(found.form_factors, expected.form_factors);
  }
  EXPECT_GT(std::ranges::count_if(expected.shares, [](float v) { return v > 0 && v < 1; }), 500);
}

/// The order of triangles changes the order of a sum, and so its last digit.
TEST_F(ExactRows, OrderOfTriangles) {
  const scenes::Scene scene = tests::shipped_scene("self-shadow");
  const SoftStage stage(scene, device(), 64, 64);
  SceneFloats turned = stage.floats;
  std::mt19937 random(7);
  std::vector<std::uint32_t> order(turned.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), random);
  std::vector<std::uint32_t> place(order.size());
  const auto permuted = [&](auto& list) {
    const auto old = list;
    for (std::size_t i = 0; i < order.size(); ++i) list[i] = old[order[i]];
  };
  permuted(turned.triangles);
  permuted(turned.object);
  permuted(turned.plane);
  permuted(turned.casts_shadow);
  permuted(turned.receives_shadow);
  permuted(turned.emits);
  for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  // A plane's number is the number of its first triangle.
  for (std::uint32_t& plane : turned.plane) {
    if (plane != SceneFloats::kNoPlane) plane = place[plane];
  }
  ViewSamples samples = stage.samples;
  for (std::int32_t& triangle : samples.triangle) {
    if (triangle >= 0) triangle = static_cast<std::int32_t>(place[static_cast<std::size_t>(triangle)]);
  }
  const auto method = make();
  const std::vector<float> one = run(*method, stage.floats, stage.light, stage.samples).shares;
  const std::vector<float> other = run(*method, turned, stage.light, samples).shares;
  double largest = 0;
  for (std::size_t i = 0; i < one.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(one[i]) - static_cast<double>(other[i])));
  // Clusters are the same, so every edge is at the same place. The difference is in sums of some hundred doubles,
  // rounded to float once.
  EXPECT_LE(largest, 0x1p-24);
}

TEST_F(ExactRows, SaysWhatItCannotDo) {
  EXPECT_THROW(make_edge_scatter(device(), {{"rows", "exact"}, {"engine", "vulkan"}}), UsageError);
  EXPECT_THROW(make_edge_scatter(device(), {{"rows", "fine"}}), UsageError);
  EXPECT_THROW(make_edge_scatter(device(), {{"engine", "abacus"}}), UsageError);
}

}  // namespace
}  // namespace penumbra::volumes
