// SPDX-License-Identifier: Apache-2.0
// Tests backproject-peel: layers, midpoints and strides.

#include "tests/analytic/maps/backprojection_scenes.hpp"
#include "tests/analytic/maps/parallel_square.hpp"
#include "reference/methods.hpp"

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

/// Errors against the exact area; `leak` and `dark`: shares of the umbra's pixels above 0.05 and of lit pixels below
/// 0.95.
struct Quality {
  double bias = 0, rmse = 0, leak = 0, dark = 0;
};

class MapsPeel : public MapsTest {
 protected:
  static Masks exact(const Stage& stage) { return tests::run(*reference::make_exact({}), stage); }
  static Quality quality(const Stage& stage, const Masks& truth, const Masks& found, const char* name) {
    Quality q;
    std::size_t count = 0, umbra = 0, lit = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      if (!visibility::is_receiver(stage.floats, stage.light, stage.samples, i)) continue;
      const double v = found.visibility[i], is = truth.visibility[i];
      ++count;
      q.bias += v - is;
      q.rmse += (v - is) * (v - is);
      umbra += is == 0 ? 1 : 0;
      q.leak += is == 0 && v > 0.05 ? 1 : 0;
      lit += is == 1 ? 1 : 0;
      q.dark += is == 1 && v < 0.95 ? 1 : 0;
    }
    q.bias /= static_cast<double>(count);
    q.rmse = std::sqrt(q.rmse / static_cast<double>(count));
    q.leak /= std::max<double>(1, static_cast<double>(umbra));
    q.dark /= std::max<double>(1, static_cast<double>(lit));
    fmt::print("{}: bias {:+.4f}, RMSE {:.4f}, leak {:.3f}, dark {:.3f}\n", name, q.bias, q.rmse, q.leak, q.dark);
    return q;
  }
  static Masks peel(const Stage& stage, const MethodOptions& options, const char* size = "64") {
    MethodOptions all{{"size", size}};
    for (const auto& [key, value] : options) all[key] = value;
    return run(maps::make_backproject_peel, stage, all);
  }
  static Masks project(const Stage& stage, const MethodOptions& options, const char* size = "64") {
    MethodOptions all{{"size", size}, {"search", "none"}};
    for (const auto& [key, value] : options) all[key] = value;
    return run(maps::make_backproject, stage, all);
  }
};

// backproject-peel with one layer and all samples is backproject without fill.
TEST_F(MapsPeel, OneLayerIsBackproject) {
  for (const scenes::Scene& scene : {sphere_over_floor(), square_above_plate(), oblique_quad(0.4)}) {
    const Stage stage = on_floor(scene, 12, light_samples(1));
    EXPECT_EQ(peel(stage, {{"layers", "1"}, {"samples", "0"}, {"depth", "first"}}).visibility,
              project(stage, {{"fill", "none"}}).visibility);
  }
  // A sheet has one surface, however many layers are asked for.
  const Stage stage = on_floor(oblique_quad(0.4), 12, light_samples(1));
  EXPECT_EQ(peel(stage, {{"layers", "3"}, {"samples", "0"}}).visibility, project(stage, {{"fill", "none"}}).visibility);
}

// However many texels one sample stands for, the blocks cover the kernel: under a plate that covers the kernel all is
// hidden.
TEST_F(MapsPeel, AStrideLosesNoCoverage) {
  scenes::Scene scene = parallel_square();
  scene.objects[0].casts_shadow = false;
  const Stage stage = on_floor(scene, 24, light_samples(1));
  for (const char* samples : {"0", "1", "2", "4", "9", "30", "121", "1000"}) {
    const Masks found = peel(stage, {{"samples", samples}}, "128");
    std::size_t umbra = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      // A block may be as wide as the kernel: each block's texel is under the plate only where the whole kernel is. The
      // umbra is ±1/3 on the map; the kernel is 0.2 wide, the plate 0.667: p must be within 1/3 less a texel.
      const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
      if (std::max(std::abs(p.x), std::abs(p.z)) > 1 - 0.1) continue;
      ++umbra;
      EXPECT_EQ(found.visibility[i], 0) << samples;
    }
    EXPECT_GT(umbra, 5U);
  }
}

// Light gets between a plate and a square above it, because the plate has no texels in the square's shadow. The leak is
// gone with the second layer, and with filled gaps, which shade too much elsewhere.
TEST_F(MapsPeel, TheSecondLayerClosesTheGapUnderASquare) {
  const Stage stage = on_floor(square_above_plate(), 24, light_samples(1));
  const Masks truth = exact(stage);
  const Quality none = quality(stage, truth, project(stage, {{"fill", "none"}}), "square over plate, no fill"),
                edges = quality(stage, truth, project(stage, {{"fill", "edges"}}), "edges"),
                one = quality(stage, truth, peel(stage, {{"layers", "1"}, {"samples", "0"}}), "1 layer"),
                two = quality(stage, truth, peel(stage, {{"layers", "2"}, {"samples", "0"}}), "2 layers"),
                three = quality(stage, truth, peel(stage, {{"layers", "3"}, {"samples", "0"}}), "3 layers");
  EXPECT_GT(none.leak, 0.1);
  EXPECT_EQ(none.leak, one.leak);
  EXPECT_EQ(edges.leak, 0);
  EXPECT_LE(two.leak, 0.1 * one.leak);
  EXPECT_LE(three.leak, 0.1 * one.leak);
  EXPECT_LT(three.rmse, one.rmse);
  EXPECT_LT(edges.bias, none.bias);
}

// In a sphere's map depth grows outward everywhere, which leaves gaps.
TEST_F(MapsPeel, FillClosesASpheresGapsAndShadesTooMuchTheMoreTheFiner) {
  const Stage stage = on_floor(sphere_over_floor(), 20, light_samples(1));
  const Masks truth = exact(stage);
  double before = 1;
  for (const char* size : {"32", "64", "128"}) {
    const Quality none = quality(stage, truth, project(stage, {{"fill", "none"}}, size), "sphere, no fill"),
                  edges = quality(stage, truth, project(stage, {{"fill", "edges"}}, size), "edges"),
                  diagonal = quality(stage, truth, project(stage, {{"fill", "diagonal"}}, size), "diagonal");
    EXPECT_LT(edges.bias, none.bias);
    EXPECT_LE(diagonal.bias, edges.bias);
    EXPECT_LE(edges.leak, none.leak);
    EXPECT_LT(edges.bias, before + 0.002) << "more overshadowing at size " << size;
    before = edges.bias;
  }
  // The back of a sphere has overlaps instead of gaps. Where the back misses the light and the front does not, both are
  // added.
  const Masks back = peel(stage, {{"samples", "0"}, {"select", "deepest"}}, "128");
  const Quality deepest = quality(stage, truth, back, "peel, deepest"),
                some = quality(stage, truth, peel(stage, {{"samples", "121"}, {"select", "deepest"}}, "128"),
                               "peel, deepest, 121"),
                both = quality(stage, truth, peel(stage, {{"samples", "0"}}, "128"), "peel, contribution");
  EXPECT_NEAR(some.rmse, deepest.rmse, 0.01);  // here fewer samples are not worse: 0.0594 and 0.0610
  EXPECT_LT(both.bias, deepest.bias);
  EXPECT_EQ(deepest.leak, 0);
}

// The gaps of an oblique sheet that is turned in its map are diagonal, too. In a sum gaps and overlaps partly cancel;
// in a union they do not.
TEST_F(MapsPeel, AnObliqueSheetLeaksThroughDiagonals) {
  const Stage stage = on_floor(oblique_quad(std::numbers::pi / 4), 20, light_samples(256));
  const Masks truth = exact(stage);
  const Quality none = quality(stage, truth, project(stage, {{"fill", "none"}}), "oblique, sum, no fill"),
                edges = quality(stage, truth, project(stage, {{"fill", "edges"}}), "sum, edges"),
                diagonal = quality(stage, truth, project(stage, {{"fill", "diagonal"}}), "sum, diagonal");
  const auto joined = [&](const char* fill, const char* name) {
    return quality(stage, truth,
                   run(maps::make_bitmask, stage, {{"size", "64"}, {"occluder", "patch"}, {"fill", fill}}), name);
  };
  const Quality union_none = joined("none", "union, no fill"), union_edges = joined("edges", "union, edges"),
                union_diagonal = joined("diagonal", "union, diagonal");
  EXPECT_GT(union_none.leak, 0);
  EXPECT_LT(union_edges.leak, union_none.leak);
  EXPECT_LT(union_diagonal.bias, union_edges.bias) << "corners are still open between edges";
  EXPECT_LT(std::abs(none.bias), std::abs(union_none.bias));
  EXPECT_LT(diagonal.bias, edges.bias) << "a sum overlaps twice";
}

// A texture's texels weight what patches cover: the error is about that of a white light.
TEST_F(MapsPeel, ATexturedLightIsWeighedTexelByTexel) {
  scenes::Scene scene = parallel_square();
  scene.objects[0].casts_shadow = false;
  const auto error = [&] {
    const Stage stage = on_floor(scene, 20, light_samples(256));
    const Masks truth = exact(stage);
    return std::pair(quality(stage, truth, project(stage, {{"fill", "edges"}}, "128"), "sum").rmse,
                     quality(stage, truth, run(maps::make_bitmask, stage, {{"size", "128"}}), "bits").rmse);
  };
  const auto white = error();
  scenes::Texture texture;
  texture.width = 3;
  texture.height = 2;
  texture.texels = {{1, 1, 1}, {8, 8, 8}, {3, 3, 3}, {0, 0, 0}, {5, 5, 5}, {9, 9, 9}};
  scene.lights.front().texture = texture;
  const auto textured = error();
  // An edge that is off by a share of the light's width moves V by that share times the brightest column over the mean,
  // 13 / 8.67.
  EXPECT_LT(textured.first, 2 * white.first);
  EXPECT_LT(textured.second, 2 * white.second + 0.01);
}

// A larger bias lights what would shade itself. A bias as large as casters are high also lights the shadow where they
// stand: 32 texels of 0.04, for a ball 1.2 high.
TEST_F(MapsPeel, TheBiasTradesAcneForLeaks) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  add_object(scene, "ball", sphere({0, 0.6, 0}, 0.6, 12));
  scene.lights.push_back(ceiling_light(4, 0.4));
  scene.cameras.push_back(camera({2, 2, 2}, {0, 0.3, 0}, 45));
  const Stage stage(scene, 40, 40, light_samples(1));
  const Masks truth = exact(stage);
  std::vector<Quality> found;
  for (const char* bias : {"0", "0.5", "32"}) {
    found.push_back(quality(stage, truth, project(stage, {{"fill", "none"}, {"bias", bias}}, "96"), bias));
  }
  EXPECT_LT(found[1].dark, found[0].dark);
  EXPECT_LE(found[2].dark, found[1].dark);
  EXPECT_GE(found[1].leak, found[0].leak);
  EXPECT_GT(found[2].leak, found[1].leak + 0.1);
}

// Bounding spheres of square patches cover π/2 times the patches' area where no other patch is near; the light is
// replaced by a disk of equal area.
TEST_F(MapsPeel, BoundingSpheresCoverHalfPiAsMuch) {
  scenes::Scene scene = bare_floor(1, 0.5);
  add_quad(scene, {0, 1, 0}, {0.05, 0, 0}, {0, 0, -0.05}).receives_shadow = false;
  const Stage stage = on_floor(scene, 12, light_samples(1));
  const Masks patch = project(stage, {{"fill", "none"}}, "64"), sphere = project(stage, {{"form", "sphere"}}, "64");
  double ratio = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
    if (stage.samples.triangle[i] < 0 || std::max(std::abs(p.x), std::abs(p.z)) > 0.1) continue;
    ratio += (1.0 - sphere.visibility[i]) / (1.0 - patch.visibility[i]);
    ++count;
  }
  ASSERT_GT(count, 0U);
  fmt::print("spheres cover {:.3f} of what patches do, {} pixels\n", ratio / static_cast<double>(count), count);
  // Seen from below, the light's disk has the angle atan(1.128 / 5) and the solid angle 2 π (1 − cos) = 0.1541 sr,
  // where the square's area at its middle gives 4 / 25 = 0.16. The ratio is larger by 0.16 / 0.1541, and smaller by the
  // patch's cosine, which is 1 here.
  EXPECT_NEAR(ratio / static_cast<double>(count), std::numbers::pi / 2 * 0.16 / 0.1541, 0.03);
}

// A closed body whose own surface is tested without bias: the midpoint between its near and far surfaces is away from
// both.
TEST_F(MapsPeel, MidpointsRemoveAcneOfClosedSolids) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, -3});
  add_object(scene, "ball", sphere({0, 1.4, 0}, 1, 12));
  scene.lights.push_back(ceiling_light(5, 0.5));
  scene.cameras.push_back(camera({0, 4, 2}, {0, 1, 0}, 50));
  const Stage stage(scene, 32, 32, light_samples(1));
  const Masks truth = exact(stage);
  // Only pixels of the ball count: the floor is one open sheet, whose shadow begins at its only surface, and the bias
  // is 0 there, too.
  Quality first, midpoint;
  const Masks with_first = project(stage, {{"fill", "none"}, {"bias", "0"}, {"depth", "first"}}),
              with_midpoint = project(stage, {{"fill", "none"}, {"bias", "0"}, {"depth", "midpoint"}});
  std::size_t lit = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const std::int32_t triangle = stage.samples.triangle[i];
    if (triangle < 0 || stage.floats.object[static_cast<std::size_t>(triangle)] != 1 || truth.visibility[i] < 1)
      continue;
    ++lit;
    first.dark += with_first.visibility[i] < 0.95 ? 1 : 0;
    midpoint.dark += with_midpoint.visibility[i] < 0.95 ? 1 : 0;
  }
  fmt::print("of {} lit pixels of the ball {} are dark by the first layer, {} by midpoints\n", lit, first.dark,
             midpoint.dark);
  ASSERT_GT(lit, 30U);
  EXPECT_LE(midpoint.dark, 0.1 * first.dark + 1);
}

// A wall beside a lit floor: it is in the map, but in no pyramid from the floor to the light.
TEST_F(MapsPeel, WhatIsBesideTheLightsPyramidShadesNothing) {
  scenes::Scene scene = bare_floor(0.5, 1);
  add_quad(scene, {1.2, 2, 0}, {0, 2, 0}, {0, 0, 1.2}).receives_shadow = false;
  const Stage stage = on_floor(scene, 16, light_samples(64));
  const Masks truth = exact(stage);
  for (const auto& [name, found] : {std::pair("backproject", project(stage, {{"fill", "edges"}})),
                                    std::pair("peel", peel(stage, {{"samples", "0"}})),
                                    std::pair("bitmask", run(maps::make_bitmask, stage, {{"size", "64"}}))}) {
    EXPECT_EQ(quality(stage, truth, found, name).dark, 0) << name;
  }
}

}  // namespace
}  // namespace penumbra::tests
