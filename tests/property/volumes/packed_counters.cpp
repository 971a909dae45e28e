// SPDX-License-Identifier: Apache-2.0
// Tests depth-complexity variant=forest against its twins and exact predicates: every counter, and pixels without a
// valid counter.

#include "tests/agreement/volumes/packed_counters.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "mesh/shapes/shapes.hpp"
#include "tests/agreement/differences.hpp"
#include "tests/agreement/lattice.hpp"
#include "tests/agreement/volumes/light_span.hpp"
#include "tests/unit/mesh/shuffled.hpp"
#include "volumes/counters/methods.hpp"
#include "volumes/scatter/methods.hpp"

#include <cmath>

namespace penumbra::volumes {
namespace {

using tests::PackedTotals;
using tests::Stage;

class Packed : public tests::DeviceTest {
 protected:
  PackedTotals check(const std::string& name, const scenes::Scene& scene, std::uint32_t width, std::uint32_t height,
                     const visibility::SampleRequest& request, std::size_t by_edges) {
    const Stage stage(scene, width, height, request);
    const PackedTotals found = tests::expect_packed(*method_, stage.floats, stage.samples, stage.light, by_edges, name);
    totals_ += found;
    open_ += method_->counters()["openPairs"];
    return found;
  }

  void say() const {
    fmt::print(
        "{} pairs, {} with a counter, {} of them above 1, {} below 0, {} too bright, {} by edges; {} left open\n",
        totals_.pairs, totals_.known, totals_.several, totals_.negative, totals_.too_bright, totals_.by_edges, open_);
    EXPECT_GT(totals_.by_edges, totals_.known / 60);
  }

  std::unique_ptr<DepthCounters> method_ = make_packed_counters(device(), {.keeps_counters = true});
  PackedTotals totals_;
  std::uint64_t open_ = 0;
};

visibility::SampleRequest request_of(std::uint32_t i) {
  using visibility::SamplePattern;
  const SamplePattern patterns[] = {SamplePattern::rows, SamplePattern::sobol, SamplePattern::jittered};
  const std::uint32_t counts[] = {16, 45, 16, 11};  // 45 takes two passes, the second one incomplete
  return {counts[i % 4], 0, 0, patterns[i % 3], i};
}

TEST_F(Packed, CountersEqualTheTwinsOnEveryDefect) {
  std::uint32_t i = 0;
  for (const mesh::DefectName& defect : mesh::broken_defects()) {
    const auto broken = mesh::make_broken_mesh({{std::string(defect.name)}, 2, {0, 1, 0}, 1});
    check(std::string(defect.name), tests::with_a_floor(broken.soup), 20, 15, request_of(i++), 40);
  }
  say();
  EXPECT_GT(totals_.known, totals_.pairs / 2);
  EXPECT_GT(totals_.several, totals_.pairs / 100);
}

/// Returns whether this is the refusal of a scene in which a triangle reaches through the light.
bool reaches_through(const InputError& error) {
  return tests::says(error, "reaches through it, which depth-complexity variant=forest cannot count");
}

/// Tests lattice soups; `range` as in LatticeSoup. Scenes with triangles that reach through their light are refused.
std::size_t lattice_soups(PackedTotals& totals, std::uint64_t& open, DepthCounters& method, int range,
                          std::uint32_t count) {
  std::size_t refused = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t seed = i + 1000 * static_cast<std::uint32_t>(range);
    tests::LatticeSoup soup(seed, range);
    visibility::SampleRequest request;
    scenes::Scene scene = tests::lattice_scene(soup, request);
    const std::uint32_t rows = std::min(request.rows, 3U);
    request = {rows * std::min(request.columns, 5U), rows, std::min(request.columns, 5U), request.pattern, 0};
    for (std::uint32_t camera = 0; camera < 3; ++camera) {
      std::rotate(scene.cameras.begin(), scene.cameras.begin() + 1, scene.cameras.end());
      const Stage stage(scene, 9, 7, request);
      const std::string name = fmt::format("seed {}, range {}, camera {}", seed, range, camera);
      try {
        totals += tests::expect_packed(method, stage.floats, stage.samples, stage.light, 63, name);
        open += method.counters()["openPairs"];
      } catch (const InputError& error) {
        if (!reaches_through(error)) throw;
        ++refused;
      }
    }
  }
  return refused;
}

TEST_F(Packed, LatticeSoups) {
  std::size_t refused = 0;
  for (const int range : {1, 2, 4}) refused += lattice_soups(totals_, open_, *method_, range, 12);
  say();
  fmt::print("{} of 108 pictures refused\n", refused);
  EXPECT_LT(refused, 80U);
  EXPECT_GT(totals_.known, 1000U);
}

using PackedFull = Packed;
TEST_F(PackedFull, LatticeSoups) {
  for (const int range : {1, 2, 4, 16}) lattice_soups(totals_, open_, *method_, range, 200);
  say();
  EXPECT_GT(totals_.known, 50000U);
}

/// Triangles all around lights of every kind, mostly in general position.
TEST_F(Packed, SoupsAroundEveryKindOfLight) {
  std::size_t refused = 0;
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&] { return glm::dvec3(real(random), real(random), real(random)); };
    scenes::Scene scene;
    std::vector<tests::Corners> soup;
    for (int i = 0; i < 12; ++i) {
      const glm::dvec3 a = point();
      soup.push_back(i % 4 != 0 ? tests::Corners{a, a + 0.5 * point(), a + 0.5 * point()}
                                : tests::Corners{a, point(), point()});
    }
    tests::add_object(scene, "soup", soup);
    scene.lights.push_back(tests::rectangle_light(0.8 * point(), 0.4 * point(), 0.4 * point()));
    if (seed % 4 == 1) scene.lights[0].shape = scenes::Disk{0.8 * point(), glm::normalize(point()), 0.3};
    if (seed % 4 == 2) {
      const glm::dvec3 o = 0.8 * point(), u = 0.4 * point(), v = 0.4 * point();
      scene.lights[0].shape = scenes::Polygon{{o, o + u, o + 0.7 * (u + v), o + v}};
    }
    if (seed % 4 == 3) scene.lights[0].shape = scenes::Ellipse{0.8 * point(), 0.4 * point(), 0.2 * point()};
    scene.lights[0].two_sided = seed % 2 == 0;
    scene.cameras.push_back(tests::camera(2.0 * point(), 0.3 * point(), 60));
    try {
      check(fmt::format("seed {}", seed), scene, 16, 12, request_of(seed), 50);
    } catch (const InputError& error) {
      if (!reaches_through(error)) throw;
      ++refused;
    }
  }
  say();
  fmt::print("{} of 24 refused\n", refused);
  EXPECT_LT(refused, 18U);
  EXPECT_LT(open_, totals_.pairs / 100);  // in general position hardly any sign is in doubt
  EXPECT_GT(totals_.too_bright, 0U);      // the paper's approximation shows
}

/// Occluders whose planes all miss the light: all points of the light see the same silhouettes.
scenes::Scene boards() {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {5, 0, 0}, {0, 0, -5}));
  tests::add_object(scene, "board", tests::quad({0.3, 1.1, 0.2}, {0.7, 0, 0.1}, {0.1, 0.05, -0.6}));
  tests::add_object(scene, "under it", tests::quad({0.1, 0.6, 0.1}, {0.6, 0.1, 0}, {0, 0, -0.7}));
  std::vector<tests::Corners> doubled = tests::quad({-1.2, 0.9, 0.4}, {0.5, 0, 0}, {0, 0, -0.5});
  for (const auto& [a, b, c] : std::vector(doubled)) doubled.push_back({a, c, b});
  tests::add_object(scene, "closed and flat", doubled);
  // The tetrahedron's three upper faces face every point of the light, its base faces none.
  const glm::dvec3 top{1.5, 1.1, -0.8}, a{1.1, 0.9, -0.5}, b{1.9, 0.9, -0.5}, c{1.5, 0.9, -1.3};
  tests::add_object(scene, "tetrahedron", {{a, b, top}, {b, c, top}, {c, a, top}, {a, c, b}});
  scene.lights.push_back(tests::rectangle_light({0.2, 5, 0.1}, {0.6, 0.02, 0.05}, {0.01, 0.03, 0.6}));
  scene.cameras.push_back(tests::camera({2.5, 4, 3.5}, {0, 0, 0}));
  return scene;
}

TEST_F(Packed, BoardsAreExact) {
  for (const std::uint32_t i : {0U, 1U, 2U}) {
    const Stage stage(boards(), 48, 36, request_of(i));
    const tests::Masks masks = tests::run(*method_, stage.floats, stage.light, stage.samples);
    tests::PairCounts counts;
    EXPECT_TRUE(equals_truth(stage.floats, stage.light, stage.samples, masks, &counts));
    EXPECT_GT(counts.blocked, counts.pairs / 50);
    EXPECT_LT(method_->counters()["openPairs"], counts.pairs / 200);
    EXPECT_EQ(method_->counters()["overflowPixels"], 0U);
    const tests::Differences found =
        tests::differences(stage.floats, stage.samples, stage.light, masks, tests::trace(stage));
    EXPECT_EQ(found.mapped_right, found.judged) << found.first_wrong;
    EXPECT_EQ(tests::differing_bits(masks, tests::run(*method_, stage.floats, stage.light, stage.samples, 5)), 0U);
  }
}

/// `count` boards in one place: together they have edges of multiplicity `count`.
scenes::Scene stack(std::uint32_t count) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {5, 0, 0}, {0, 0, -5}));
  const std::vector<tests::Corners> boards(count, {{{-0.9, 1, 0.8}, {1.1, 1, 0.7}, {0.2, 1.1, -1}}});
  tests::add_object(scene, "boards", boards);
  scene.lights.push_back(tests::ceiling_light(5, 1));
  scene.cameras.push_back(tests::camera({2.5, 4, 3.5}, {0, 0, 0}));
  return scene;
}

/// Every bit equals that of edge-scatter for the same light samples, in one pass of 32 and in several, the last one
/// full or not.
TEST_F(Packed, BoardsAreExactAtAnyNumberOfLightSamples) {
  const auto scatter = make_edge_scatter(device(), {});
  std::uint32_t seed = 0;
  for (const std::uint32_t count : {1U, 31U, 32U, 33U, 64U, 100U, 256U, 300U}) {
    const auto pattern = seed % 2 == 0 ? visibility::SamplePattern::sobol : visibility::SamplePattern::rows;
    const Stage stage(boards(), 32, 24, {count, 0, 0, pattern, seed++});
    const tests::Masks masks = tests::run(*method_, stage.floats, stage.light, stage.samples),
                       scattered = tests::run(*scatter, stage.floats, stage.light, stage.samples);
    EXPECT_EQ(masks.words_per_pixel, (stage.light.sample_count() + 31) / 32);
    EXPECT_EQ(masks.words, scattered.words) << count;
    EXPECT_EQ(masks.visibility, scattered.visibility) << count;
    EXPECT_EQ(tests::run(*method_, stage.floats, stage.light, stage.samples, 5).words, masks.words) << count;
    EXPECT_EQ(method_->counters()["overflowPixels"], 0U);
  }
}

/// With the light samples in the opposite order, they are in other passes, next to other counters: each must keep its
/// bit.
TEST_F(Packed, NoBitDependsOnThePass) {
  for (const bool overflows : {false, true}) {
    const auto method = make_packed_counters(device(), {.counter_bits = 6});
    const auto soup = mesh::make_icosphere({0, 1.2, 0}, 0.8, 2);
    const Stage stage(overflows ? stack(64) : tests::with_a_floor(soup), 24, 18,
                      {75, 0, 0, visibility::SamplePattern::sobol, 3});
    visibility::Light turned = stage.light;
    std::ranges::reverse(turned.points);
    std::ranges::reverse(turned.coordinates);
    const tests::Masks masks = tests::run(*method, stage.floats, stage.light, stage.samples);
    const std::uint64_t overflow_pixels = method->counters()["overflowPixels"];
    const tests::Masks other = tests::run(*method, stage.floats, turned, stage.samples);
    EXPECT_EQ(overflow_pixels > 0, overflows);
    EXPECT_EQ(method->counters()["overflowPixels"], overflow_pixels);
    std::size_t differing = 0, blocked = 0;
    for (std::size_t pixel = 0; pixel < stage.samples.size(); ++pixel) {
      for (std::uint32_t j = 0; j < 75; ++j) {
        differing += masks.visible(pixel, j) != other.visible(pixel, 74 - j) ? 1U : 0U;
        blocked += masks.visible(pixel, j) ? 0U : 1U;
      }
    }
    EXPECT_EQ(differing, 0U) << overflows;
    EXPECT_GT(blocked, 75U);
  }
}

/// A sheet in shallow pleats, tilted so that view samples are off its planes by more than rounding, under light along
/// the sheet: segments to the light pass through planes of carriers, past edges that are no silhouettes.
TEST_F(Packed, RoundedOffTheCarrierUnderGrazingLight) {
  const glm::dvec3 u = glm::normalize(glm::dvec3(0.8, 0.31, -0.23)),
                   v = glm::normalize(glm::cross(u, glm::dvec3(0.17, 0.9, 0.41))), n = glm::cross(v, u);
  constexpr int kFolds = 60;
  const auto at = [&](int i, double y) {
    return 2.0 * (static_cast<double>(i) / kFolds - 0.5) * u + y * v + (i % 2 == 0 ? 1e-4 : -1e-4) * n;
  };
  std::vector<tests::Corners> sheet;
  for (int i = 0; i < kFolds; ++i) {
    sheet.push_back({at(i, -1), at(i + 1, -1), at(i + 1, 1)});
    sheet.push_back({at(i, -1), at(i + 1, 1), at(i, 1)});
  }
  scenes::Scene scene;
  tests::add_object(scene, "pleats", sheet);
  tests::add_object(scene, "far away",
                    tests::quad(-60.0 * n, u, v));  // puts the origin half way there, so that floats are coarse
  scene.lights.push_back(tests::rectangle_light(4.0 * u + 0.03 * n, 0.5 * v, 0.028 * n));
  scene.lights[0].two_sided = true;
  scene.cameras.push_back(tests::camera(2.5 * n + 0.1 * u, {0, 0, 0}, 40));
  const PackedTotals found = check("pleats", scene, 64, 48, {16, 0, 0, visibility::SamplePattern::rows, 0}, 200);
  say();
  EXPECT_GT(open_, 0U);
  EXPECT_GT(found.known, found.pairs / 10);
}

/// A ball is too bright where the light's corners see past the centre's silhouette, and never too dark.
TEST_F(Packed, ABallIsTooBright) {
  const PackedTotals found = check("ball", tests::with_a_floor(mesh::make_icosphere({0, 1.2, 0}, 0.8, 2)), 48, 36,
                                   {16, 0, 0, visibility::SamplePattern::rows, 0}, 30);
  say();
  EXPECT_GT(found.too_bright, 0U);
  EXPECT_LT(found.too_bright, found.pairs / 50);
}

void expect_overflow(const render::Device& device, std::uint32_t bits, std::uint32_t size) {
  // Modulo 2^bits the counter is 0: without a guard, an umbra that does not contain the centre's shadow would be lit.
  const auto method = make_packed_counters(device, {.counter_bits = bits});
  for (const std::uint32_t count : {((1U << (bits - 1)) - 1) / 3, 1U << bits}) {
    const Stage stage(stack(count), size, size, {16, 0, 0, visibility::SamplePattern::rows, 0});
    const tests::Masks masks = tests::run(*method, stage.floats, stage.light, stage.samples);
    tests::PairCounts counts;
    EXPECT_TRUE(equals_truth(stage.floats, stage.light, stage.samples, masks, &counts)) << count;
    EXPECT_GT(counts.blocked, 0U);
    const std::uint64_t overflows = method->counters()["overflowPixels"];
    EXPECT_EQ(overflows > 0, count == 1U << bits) << count << " boards: " << overflows;
  }
}

TEST_F(Packed, OverflowIsSeenAndSetRight) {
  expect_overflow(device(), 6, 24);
  expect_overflow(device(), 8, 24);
}
/// With as=published, a counter that edges change by 2^bits has its old value: all of the light is visible where the
/// light's centre is. Where nothing overflows, both variants give the same.
TEST_F(Packed, AsPublishedOverflowLetsLightThrough) {
  for (const std::uint32_t bits : {6U, 8U}) {
    const auto published = make_packed_counters(device(), {.counter_bits = bits, .as_published = true}),
               repaired = make_packed_counters(device(), {.counter_bits = bits});
    for (const std::uint32_t count : {((1U << (bits - 1)) - 1) / 3, 1U << bits}) {
      const Stage stage(stack(count), 24, 24, {16, 0, 0, visibility::SamplePattern::rows, 0});
      const tests::Masks as_is = tests::run(*published, stage.floats, stage.light, stage.samples),
                         right = tests::run(*repaired, stage.floats, stage.light, stage.samples);
      std::size_t brighter = 0, differing = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        brighter += as_is.visible_count(i) > right.visible_count(i) ? 1U : 0U;
        differing += as_is.visible_count(i) != right.visible_count(i) ? 1U : 0U;
      }
      const bool overflows = count == 1U << bits;
      EXPECT_EQ(differing > 0, overflows) << count;
      EXPECT_EQ(brighter > 3, overflows) << count << ": " << brighter;
    }
  }
}

TEST_F(PackedFull, OverflowOfSixteenBits) {
  expect_overflow(device(), 16, 10);
}

TEST_F(Packed, TheOrderOfTrianglesChangesNoBit) {
  scenes::Scene scene =
      tests::with_a_floor(mesh::make_broken_mesh({{"t-junction", "fin", "piercing"}, 2, {0, 1, 0}, 1}).soup);
  const visibility::SampleRequest request{16, 0, 0, visibility::SamplePattern::rows, 0};
  const Stage before(scene, 32, 24, request);
  const tests::Masks once = tests::run(*method_, before.floats, before.light, before.samples);
  std::mt19937 random(5);
  tests::shuffle_order(scene.soup, random);
  tests::shuffle_corners(scene.soup, random);
  const Stage after(scene, 32, 24, request);
  EXPECT_EQ(tests::run(*method_, after.floats, after.light, after.samples).words, once.words);
}

TEST_F(Packed, WhatItCannotDoIsRefused) {
  const auto make = [&](const visibility::MethodOptions& options) { return make_depth_complexity(device(), options); };
  EXPECT_THROW(make({{"variant", "forest"}, {"crop", "on"}}), UsageError);
  EXPECT_THROW(make({{"variant", "forest"}, {"counter-bits", "7"}}), UsageError);
  EXPECT_THROW(make({{"counter-bits", "8"}}), UsageError);
  EXPECT_THROW(make({{"crop", "maybe"}}), UsageError);
  const auto refusal = [&](const scenes::Scene& scene, std::uint32_t samples) {
    const Stage stage(scene, 8, 6, {samples, 0, 0, visibility::SamplePattern::sobol, 0});
    const auto method = make({{"variant", "forest"}});
    try {
      tests::run(*method, stage.floats, stage.light, stage.samples);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("variant=soup"), std::string::npos) << error.what();
      return static_cast<int>(error.code());
    }
    return 0;
  };
  EXPECT_EQ(refusal(boards(), 16), 0);
  scenes::Scene through = boards();
  tests::add_object(through, "through", {tests::Corners{{{-0.2, 5.3, -3}, {0.4, 4.7, 3}, {-0.2, 4.7, 3}}}});
  EXPECT_EQ(refusal(through, 16), 3);
  scenes::Scene beside = boards();
  tests::add_object(beside, "beside", {tests::Corners{{{3.2, 5.3, -3}, {3.4, 4.7, 3}, {3.2, 4.7, 3}}}});
  EXPECT_EQ(refusal(beside, 16), 0);
}

}  // namespace
}  // namespace penumbra::volumes
