// SPDX-License-Identifier: Apache-2.0
// Tests statements of papers about bitmask, on every scene of a class; the numbers B2 to B8 are rows of
// docs/predicates.md.

#include "tests/analytic/maps/predicates.hpp"

#include <numbers>
#include <set>

namespace penumbra::tests {
namespace {

/// Returns the share of the umbra's pixels that are brighter than 0.05.
double leak(const Masks& found, const Masks& truth) {
  double umbra = 0, lit = 0;
  for (std::size_t i = 0; i < found.visibility.size(); ++i) {
    if (truth.visibility[i] > 0) continue;
    umbra += 1;
    lit += found.visibility[i] > 0.05F ? 1 : 0;
  }
  EXPECT_GT(umbra, 20);
  return lit / umbra;
}

// B6 (Schwarz and Stamminger 2007): quads of a connected surface share their borders, so that no light leaks through as
// it does between patches.
TEST_F(MapsPredicates, QuadsOfATiltedPlaneDoNotLeakAsPatchesDo) {
  const Stage stage = on_floor(oblique_quad(), 32, light_samples(256));
  const Masks truth = exact(stage);
  const auto leak_of = [&](const char* occluder) {
    return leak(run(maps::make_bitmask, stage, {{"size", "128"}, {"occluder", occluder}}), truth);
  };
  const double quads = leak_of("quad"), patches = leak_of("patch");
  record("B6 leak of quads", quads);
  record("B6 leak of patches", patches);
  EXPECT_LE(quads, 0.02);
  EXPECT_GT(patches, 0.2);
}

// B5 (Schwarz and Stamminger 2007): triangles at the outline recover some of what quads lose. The loss of both falls
// with the size of texels, down to what the light's centre does not see.
TEST_F(MapsPredicates, TrianglesLoseLessThanQuads) {
  const Stage stage = on_floor(sphere_over_floor(), 20, light_samples(256));
  const Masks truth = exact(stage);
  double last_quads = 1, last_triangles = 1;
  for (const char* size : {"24", "46", "90"}) {  // 13, 25 and 50 texels across the sphere
    const auto bias_of = [&](const char* occluder) {
      return bias(run(maps::make_bitmask, stage, {{"size", size}, {"occluder", occluder}}), truth);
    };
    const double quads = bias_of("quad"), triangles = bias_of("triangle");
    record(fmt::format("B5 bias of quads, size {}", size), quads);
    record(fmt::format("B5 bias of triangles, size {}", size), triangles);
    EXPECT_LT(triangles, quads) << size;
    EXPECT_GT(triangles, 0) << size;
    EXPECT_LT(quads, 0.8 * last_quads) << size;
    EXPECT_LT(triangles, 0.8 * last_triangles) << size;
    last_quads = quads;
    last_triangles = triangles;
  }
}

/// A light, a wall up to the light's plane (which makes its maps hemicubes), and boards one behind the other, on the
/// wall's side and below the light.
scenes::Scene boards_one_behind_the_other() {
  scenes::Scene scene = bare_floor(0.5, 1.5);
  add_quad(scene, {-1.5, 2.5, 0}, {0, 0, 1.5}, {0, 2.5, 0}).casts_shadow = false;
  add_quad(scene, {-0.8, 3.6, 0.2}, {0.3, 0.05, 0.1}, {0.05, 0.2, -0.3}).receives_shadow = false;
  add_quad(scene, {0.5, 2.6, 0.2}, {0.3, 0.1, 0.1}, {0.1, 0.1, -0.3}).receives_shadow = false;
  add_quad(scene, {-1.1, 3.1, 0.25}, {0.2, -0.1, 0.1}, {0.05, 0.3, -0.3}).receives_shadow = false;
  add_quad(scene, {0.6, 1.6, 0.2}, {0.5, 0, 0.1}, {0, 0.2, -0.4}).receives_shadow = false;
  scene.cameras.front() = camera({1.5, 3, 1}, {-1, 1.5, 0}, 70);
  return scene;
}

// A texel has a patch for each of its layers, whichever body the layer belongs to: of two groups of bodies all layers
// together hide what each group hides alone, in a hemicube, too.
TEST_F(MapsPredicates, LayersHideWhatTheirBodiesDo) {
  scenes::Scene both = boards_one_behind_the_other(), first = both, second = both;
  for (const std::size_t i : {2U, 3U}) second.objects[i].casts_shadow = false;
  for (const std::size_t i : {4U, 5U}) first.objects[i].casts_shadow = false;
  for (const bool on_the_floor : {false, true}) {
    const auto bits = [&](const scenes::Scene& scene, const char* layers) {
      const Stage stage =
          on_the_floor ? on_floor(scene, 16, light_samples(256)) : Stage(scene, 24, 24, light_samples(256));
      return run(maps::make_bitmask, stage,
                 {{"size", "96"}, {"occluder", "patch"}, {"search", "none"}, {"bias", "0"}, {"layers", layers}});
    };
    const Masks joined = bits(both, "3"), nearest = bits(both, "1"), one = bits(first, "1"), other = bits(second, "1");
    std::size_t wrong = 0, behind = 0;
    for (std::size_t i = 0; i < joined.words.size(); ++i) {
      wrong += joined.words[i] != (one.words[i] & other.words[i]) ? 1 : 0;
      behind += joined.words[i] != nearest.words[i] ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0U) << on_the_floor;
    EXPECT_GT(behind, 50U) << "layers behind the nearest hide nothing of their own";
  }
}

// B8 (Eisemann et al. 2009, section 5.2.3.2): cost is linear in the number of maps. (Where tiles are left out by the
// nearest layer's depths, as in a closed room, further layers cost more: their depths are not known.)
TEST_F(MapsPredicates, LayersAskAsManyTimesAsMuch) {
  scenes::Scene shells = bare_floor(1, 3);
  for (int shell = 0; shell < 4; ++shell) {
    add_quad(shells, {0, 3.6 - 0.8 * shell, 0}, {0.35, 0, 0}, {0, 0, -0.35}).receives_shadow = false;
  }
  for (const scenes::Scene& scene : {shells, boards_one_behind_the_other()}) {
    const Stage stage = on_floor(scene, 16, light_samples(64));
    for (const char* occluder : {"quad", "patch"}) {
      const auto asked = [&](const char* layers) {
        const auto method = maps::make_bitmask(device(), {{"size", "64"}, {"occluder", occluder}, {"layers", layers}});
        (void)tests::run(*method, stage);
        return static_cast<double>(method->counters().at("occludersAsked"));
      };
      const double one = asked("1");
      ASSERT_GT(one, 1000);
      for (const auto& [layers, times] : {std::pair("2", 2.0), {"4", 4.0}}) {
        const double ratio = asked(layers) / one;
        record(fmt::format("B8 {} of {} layers", occluder, layers), ratio);
        EXPECT_GE(ratio, 0.9 * times) << occluder;
        EXPECT_LE(ratio, 1.1 * times) << occluder;
      }
    }
  }
}

// B2 (Eisemann et al. 2009, section 5.2.3.2): the 256 light samples of these course notes are 8 x 8 tiles of four on a
// turned square (rgss), and stand in 32 columns of eight: under an edge along these columns V has 33 levels, steps of
// 1/32. With the edge turned by 20 degrees it hardly ever passes two samples at once. Our own samples in rows stand in
// 256 columns and 16 rows.
TEST_F(MapsPredicates, TheNotesPatternHasThirtyThreeLevelsUnderAnAlignedEdge) {
  // The penumbra of an edge half way up is as wide as the light, 2: two of 256 levels are 1/128 apart.
  std::vector<double> places;
  for (int i = 0; i < 1600; ++i) places.push_back(-1.1 + 2.2 * i / 1600);
  const auto levels = [&](double degrees, bool notes, bool across) {
    scenes::Scene scene = bare_floor(1, 2);
    if (across) scene.lights.front() = rectangle_light({0, 5, 0}, {0, 0, 1}, {-1, 0, 0});
    const double angle = degrees * std::numbers::pi / 180;
    const glm::dvec3 along(-std::sin(angle), 0, std::cos(angle)), away(-std::cos(angle), 0, -std::sin(angle));
    add_quad(scene, glm::dvec3(0, 2.5, 0) + 3.0 * away, 3.0 * away, 9.0 * along).receives_shadow = false;
    visibility::SampleRequest request = light_samples(256);
    if (notes) request.pattern = visibility::SamplePattern::rgss;
    const Stage stage = along_floor(scene, places, request);
    const Masks found = run(maps::make_bitmask, stage, {{"size", "64"}, {"occluder", "patch"}});
    return std::set<float>(found.visibility.begin(), found.visibility.end()).size();
  };
  const std::size_t aligned = levels(0, true, false), turned = levels(20, true, false), rows = levels(0, false, false),
                    beside = levels(0, false, true);
  record("B2 levels of the notes' pattern, aligned", static_cast<double>(aligned));
  record("B2 levels of the notes' pattern, turned by 20 degrees", static_cast<double>(turned));
  record("B2 levels of rows, across them", static_cast<double>(rows));
  record("B2 levels of rows, along them", static_cast<double>(beside));
  EXPECT_EQ(aligned, 33U);
  EXPECT_GT(turned, 200U);
  EXPECT_EQ(std::max(rows, beside), 257U);
  EXPECT_EQ(std::min(rows, beside), 17U);
}

// B7 (Eisemann et al. 2009, section 5.2.3.3), without a bias: patches of a round body's own surface may rise above a
// receiver's plane. Quads do so less often, because all four of their corners must be above it.
TEST_F(MapsPredicates, QuadsHaveLessAcneThanPatches) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_object(scene, "ball", sphere({0, 1.4, 0}, 1, 12));
  scene.lights.push_back(ceiling_light(5, 0.5));
  scene.cameras.push_back(camera({0, 4, 2}, {0, 1, 0}, 50));
  const Stage stage(scene, 40, 40, light_samples(64));
  const Masks truth = exact(stage);
  const auto dark = [&](const char* occluder) {
    const Masks found = run(maps::make_bitmask, stage, {{"size", "64"}, {"bias", "0"}, {"occluder", occluder}});
    double lit = 0, wrong = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!on_object(stage, i, 1) || truth.visibility[i] < 1) continue;
      lit += 1;
      wrong += found.visibility[i] < 0.95F ? 1 : 0;
    }
    EXPECT_GT(lit, 100);
    return wrong / lit;
  };
  const double patches = dark("patch"), quads = dark("quad");
  record("B7 dark share of patches", patches);
  record("B7 dark share of quads", quads);
  EXPECT_GT(patches, 0.05);
  EXPECT_LT(quads, patches);
}

}  // namespace
}  // namespace penumbra::tests
