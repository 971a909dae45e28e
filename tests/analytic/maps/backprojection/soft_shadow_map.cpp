// SPDX-License-Identifier: Apache-2.0
// Tests soft-shadow-map against closed forms, and its two forms against each other and against backproject.

#include "tests/analytic/maps/backprojection/soft_shadow_map.hpp"

#include "base/error.hpp"
#include "maps/backprojection/patches/methods.hpp"
#include "tests/analytic/maps/backprojection_scenes.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace penumbra::tests {
namespace {

// A parallel rectangle, and a small one beside it so that no texel border lies on an edge. On either axis each edge is
// off by half a texel at most. Projected from the receiver onto the light, a length in the map's coordinates x / z
// grows by `to_light` = 3 · 5 / 2, because the rectangles are at depth 3 and the receivers at depth 5, 2 apart.
TEST_F(SoftShadowMap, AParallelRectangleIsOffByNoMoreThanItsTexels) {
  struct Rectangle {
    glm::dvec2 center, half;
  };
  const std::array<Rectangle, 2> rectangles{{{{0.1, 0}, {1, 0.7}}, {{2.137, 0.3}, {0.2, 0.37}}}};
  scenes::Scene scene = floor_and_light(1);
  for (const auto& [center, half] : rectangles) {
    add_quad(scene, {center.x, 2, center.y}, {half.x, 0, 0}, {0, 0, half.y});
  }
  // The receivers' map: 50 texels over +-4/5, and one more on every side.
  constexpr int kReceivers = 52;
  std::vector<glm::dvec2> places;
  for (int i = 5; i < 45; ++i) {
    for (int j = 15; j < 35; ++j) {
      places.push_back(8.0 * (glm::dvec2(i, j) + 0.5 - kReceivers / 2.0) / (kReceivers - 2.0));
    }
  }
  const Stage stage = on_floor(scene, places);
  double before = 1;
  for (const int size : {33, 66, 132, 264, 528}) {
    const MethodOptions options{{"size", std::to_string(size)}, {"receiverSize", std::to_string(kReceivers)}};
    const Run found = soft(stage, options);
    if (size < 100) {
      MethodOptions twice = options;
      twice["passes"] = "2";
      EXPECT_EQ(found.picture.visibility, soft(stage, twice).picture.visibility) << "a flat sheet has one surface";
    }
    // Widths of texels: over the x of both rectangles, and over the z of the larger one, at depth 3 of 5.
    const double to_light = 3.0 * 5.0 / 2.0, across = (2.337 + 0.9) / 3 / (size - 2), along = 1.4 / 3 / (size - 2);
    const double bound = 2 * (across + along) / 2 * to_light / 2 * 2;
    double worst = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      double covered = 0;
      for (const auto& [center, half] : rectangles) {
        const glm::dvec2 to = places[i] + (center - places[i]) * 2.5, reach = 2.5 * half;
        const glm::dvec2 overlap =
            glm::max(glm::min(to + reach, glm::dvec2(1)) - glm::max(to - reach, glm::dvec2(-1)), 0.0);
        covered += overlap.x * overlap.y / 4;
      }
      worst = std::max(worst, std::abs(static_cast<double>(found.picture.visibility[i]) - (1 - covered)));
    }
    fmt::print("{} texels: off by {:.4f} of {:.4f}\n", size, worst, bound);
    EXPECT_LE(worst, bound + 2.0 / 256 * bound + 1e-5);  // corners snap to 1/256 of a texel
    before = worst;  // errors jump with the places of texel borders, so two sizes need not be in order
  }
  EXPECT_LT(before, 0.01);
}

// The paper's equation 1: two neighbouring texels at different depths, seen from beside their common border, leave a
// gap or overlap.
TEST_F(SoftShadowMap, DepthThatGrowsOutwardLeavesAGapAndDepthThatShrinksAnOverlap) {
  scenes::Scene scene = floor_and_light(1);
  scene.objects[0].casts_shadow = false;              // makes it the receiver, though it is the smaller object
  add_quad(scene, {-6, 3, 0}, {6, 0, 0}, {0, 0, 9});  // x < 0, at depth 2
  add_quad(scene, {6, 2, 0}, {6, 0, 0}, {0, 0, 9});   // x > 0, at depth 3
  std::vector<glm::dvec2> places;
  for (int i = -12; i <= 12; ++i) places.emplace_back(8.0 * i / 101, 0);  // centres of 101 texels over the floor
  const Stage stage = on_floor(scene, places);
  const Run found = soft(stage, {{"size", "64"}, {"receiverSize", "103"}});
  for (std::size_t i = 0; i < places.size(); ++i) {
    // x of the border on the light: -alpha f(z), alpha = x / 5; f = z 5 / (5 - z).
    const double near = std::min(-places[i].x / 5 * (2.0 * 5 / 3), 1.0),
                 far = std::min(-places[i].x / 5 * (3.0 * 5 / 2), 1.0);
    const double gap = far - near;  // the gap's part on the light
    EXPECT_NEAR(static_cast<double>(found.picture.visibility[i]), std::clamp(gap / 2, 0.0, 1.0), 2e-4) << places[i].x;
  }
}

// Sums in 16-bit floats stop growing where half a unit in the last place is more than a texel: kernels of 32 texels or
// fewer are safe.
TEST_F(SoftShadowMap, SixteenBitSumsStopAsTheKernelGrows) {
  // One plate over everything, at depth 2.5 of 5. Tangents of +-2 in 400 texels give kernels 2 half (1/2.5 - 1/5) /
  // 0.01 = 40 half texels wide.
  for (const auto& [width, sum] : {std::pair(32, 1.0), std::pair(40, 0.915), std::pair(64, 0.5), std::pair(90, 0.5),
                                   std::pair(91, 0.25), std::pair(128, 0.125), std::pair(256, 0.031)}) {
    scenes::Scene scene = floor_and_light(width / 40.0);
    scene.objects[0].casts_shadow = false;
    add_quad(scene, {0, 2.5, 0}, {5, 0, 0}, {0, 0, 5});
    const Stage stage = on_floor(scene, {{0, 0}});
    const MethodOptions options{{"size", "402"}, {"receiverSize", "9"}, {"filter", "nearest"}};
    MethodOptions blended = options;
    blended["precision"] = "fp16";
    MethodOptions scattered = options;
    scattered["form"] = "scatter";
    EXPECT_EQ(soft(stage, options).picture.visibility[0], 0.0F) << width;
    EXPECT_EQ(soft(stage, scattered).picture.visibility[0], 0.0F) << width;
    const double found = 1 - static_cast<double>(soft(stage, blended).picture.visibility[0]);
    fmt::print("kernel {} texels wide: sum {:.4f}\n", width, found);
    EXPECT_NEAR(found, sum, 0.006) << width;
  }
}

TEST_F(SoftShadowMap, ScatteredAndGatheredSumsAreTheSameBits) {
  scenes::Scene stacked = ball(0.6), inside;
  add_quad(stacked, {0.8, 3.2, 0.3}, {0.5, 0.2, 0}, {0, 0.1, 0.6});
  stacked.lights.front().two_sided = true;
  add_quad(stacked, {0, 9, 0}, {3, 0, 0}, {0, 0, 3}).casts_shadow = false;
  add_quad(stacked, {0, 7, 0}, {1, 0, 0}, {0, 0, 1});
  for (const scenes::Scene& scene : {ball(0.3), stacked}) {
    const Stage stage(scene, 40, 40, light_samples(1));
    for (const char* passes : {"1", "2"}) {
      for (const char* bias : {"0", "2"}) {
        MethodOptions options{{"size", "50"}, {"receiverSize", "60"}, {"passes", passes}, {"bias", bias}};
        const Run gathered = soft(stage, options);
        options["form"] = "scatter";
        const Run scattered = soft(stage, options);
        EXPECT_EQ(gathered.picture.visibility, scattered.picture.visibility);
        EXPECT_EQ(gathered.fragments, scattered.fragments);
        EXPECT_GT(gathered.fragments, 1000U);
        EXPECT_EQ(gathered.picture.visibility,
                  soft(stage, {{"size", "50"}, {"receiverSize", "60"}, {"passes", passes}, {"bias", bias}}, 7)
                      .picture.visibility);
      }
    }
  }
  EXPECT_THROW(maps::make_soft_shadow_map(device(), {{"form", "scatter"}, {"precision", "fp16"}}), UsageError);
}

// An occluder's texel reaches 160 texels of the receivers' map: 2 % of that is more than the two texels that are added
// for rounding.
TEST_F(SoftShadowMap, AWideKernelIsScatteredWhole) {
  scenes::Scene scene = floor_and_light(4);
  add_quad(scene, {0, 2.5, 0}, {0.5, 0, 0}, {0, 0, 0.5});
  const Stage stage = on_floor(scene, {{0, 0}});
  MethodOptions options{{"size", "10"}, {"receiverSize", "322"}};
  const Run gathered = soft(stage, options);
  options["form"] = "scatter";
  const Run scattered = soft(stage, options);
  EXPECT_EQ(gathered.fragments, scattered.fragments) << "pairs of all texels of both maps";
  EXPECT_EQ(gathered.picture.visibility, scattered.picture.visibility);
}

TEST_F(SoftShadowMap, WorkDependsOnTexelsAndNotOnTriangles) {
  scenes::Scene one = floor_and_light(0.5), many = floor_and_light(0.5);
  add_quad(one, {0, 2, 0}, {1, 0, 0}, {0, 0, 1});
  std::vector<Corners> pieces;
  for (int x = -4; x < 4; ++x) {
    for (int z = -4; z < 4; ++z) {
      for (const Corners& piece : quad({(x + 0.5) / 4, 2, (z + 0.5) / 4}, {0.125, 0, 0}, {0, 0, 0.125}))
        pieces.push_back(piece);
    }
  }
  add_object(many, "pieces", pieces);
  const Stage whole(one, 16, 16, light_samples(1)), parted(many, 16, 16, light_samples(1));
  const auto work = [](const Stage& stage, const char* size, const char* receivers) {
    return soft(stage, {{"size", size}, {"receiverSize", receivers}});
  };
  const Run a = work(whole, "32", "64"), b = work(parted, "32", "64");
  EXPECT_EQ(a.patches, b.patches);
  EXPECT_EQ(a.fragments, b.fragments);
  EXPECT_EQ(a.picture.visibility, b.picture.visibility);
  // The work is occluder texels times receiver texels: sixteen times as much with both maps twice as large.
  const Run twice = work(whole, "62", "126");  // 30 and 62 texels without their margins, then 60 and 124
  const double ratio = static_cast<double>(twice.fragments) / static_cast<double>(a.fragments);
  fmt::print("work of maps twice as large: {:.2f}\n", ratio);
  // A patch reaches its own width p and the kernel's 2 k: there are four times as many patches, and each covers 4 ((p/2
  // + 2k) / (p + 2k))^2 times as many texels.
  const double p = 2.0 / 3 / 30, k = 0.5 * (1.0 / 3 - 1.0 / 5),
               expected = 16 * std::pow((p / 2 + 2 * k) / (p + 2 * k), 2);
  EXPECT_NEAR(ratio, expected, 0.03 * expected);
}

TEST_F(SoftShadowMap, ATinyLightCastsTheHardShadow) {
  scenes::Scene scene = floor_and_light(1e-6);
  add_quad(scene, {0.1, 2, 0}, {1, 0, 0}, {0, 0, 0.7});
  const Stage stage(scene, 64, 64, light_samples(1));
  const Run found = soft(stage, {{"size", "256"}, {"receiverSize", "512"}, {"filter", "nearest"}});
  std::size_t dark = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!on_object(stage, i, 0)) continue;
    const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
    const glm::dvec2 off(std::abs(p.x - 0.1 * 5 / 3) - 5.0 / 3, std::abs(p.z) - 0.7 * 5 / 3);
    const double texel = 8.0 / 510 + 10.0 / 3 / 254;  // the texels of both maps, on the floor
    if (std::abs(off.x) < texel || std::abs(off.y) < texel) continue;
    const bool shaded = off.x < 0 && off.y < 0;
    dark += shaded ? 1 : 0;
    EXPECT_EQ(found.picture.visibility[i], shaded ? 0.0F : 1.0F);
  }
  EXPECT_GT(dark, 50U);
}

/// Places of the texels of a receivers' map over a floor of half-size 4, 5 below the light.
std::vector<glm::dvec2> texel_centres(int size, int step) {
  std::vector<glm::dvec2> places;
  for (int i = 2; i < size - 2; i += step) {
    for (int j = 2; j < size - 2; j += step) {
      places.push_back(8.0 * (glm::dvec2(i, j) + 0.5 - size / 2.0) / (size - 2.0));
    }
  }
  return places;
}

// The sum at a texel of the receivers' map equals backproject's for the same map: only the order of the loops differs.
// Four small boards make the occluders' window equal to the receivers'. This holds for any planar light, with or
// without a texture; and gather and scatter give the same bits.
TEST_F(SoftShadowMap, AtATexelOfTheReceiversItIsBackproject) {
  scenes::Scene scene = ball(0.5);
  scene.objects[0].casts_shadow = false;
  add_quad(scene, {0.4, 3.2, 0.3}, {0.4, 0.15, 0}, {0, 0.1, 0.5});
  for (const double x : {-1, 1}) {
    for (const double z : {-1, 1}) add_quad(scene, {1.9 * x, 2.5, 1.9 * z}, {0.1, 0, 0}, {0, 0, 0.1});
  }
  // The light's centroid must be above the middle, where the maps' texels are.
  const std::vector<decltype(scenes::AreaLight::shape)> shapes{
      scene.lights.front().shape, scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.55},
      scenes::Ellipse{{0, 5, 0}, {0.6, 0, 0}, {0.1, 0, 0.3}}, scenes::Rectangle{{0, 5, 0}, {0.5, 0, 0}, {0.2, 0, 0.5}},
      scenes::Polygon{{{-0.5, 5, -0.3}, {0.7, 5, -0.3}, {-0.2, 5, 0.6}}}};
  for (std::size_t k = 0; k <= shapes.size(); ++k) {
    scene.lights.front().shape = shapes[k % shapes.size()];
    const Stage stage = on_floor(scene, texel_centres(66, 3));
    visibility::Light light = stage.light;
    if (k == shapes.size()) {  // the first shape again, with a texture
      light.texture = visibility::LightTexture{.width = 2,
                                               .height = 2,
                                               .colors = std::vector<glm::vec3>(4, glm::vec3(1)),
                                               .luminance = {1, 0, 0.2, 0.5},
                                               .mean_luminance = 0.425};
    }
    const auto visibility_of = [&](const Factory& factory, const MethodOptions& options) {
      return tests::run(*factory(device(), options), stage.floats, light, stage.samples).visibility;
    };
    MethodOptions options{{"size", "64"}, {"receiverSize", "66"}, {"filter", "nearest"}};
    const std::vector<float> found = visibility_of(maps::make_soft_shadow_map, options);
    options["form"] = "scatter";
    EXPECT_EQ(visibility_of(maps::make_soft_shadow_map, options), found) << k;
    const std::vector<float> sums =
        visibility_of(maps::make_backproject, {{"size", "64"}, {"bias", "0"}, {"fill", "none"}, {"search", "none"}});
    double worst = 0;
    std::size_t between = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      worst = std::max(worst, std::abs(static_cast<double>(found[i]) - static_cast<double>(sums[i])));
      between += sums[i] > 0 && sums[i] < 1 ? 1 : 0;
    }
    fmt::print("light {}: soft-shadow-map and backproject off by {:.2g} at {} places, {} in penumbrae\n", k, worst,
               sums.size(), between);
    EXPECT_GT(between, 50U);
    EXPECT_LT(worst, 1e-4);
  }
}

TEST_F(SoftShadowMap, OccludersSeeWhatIsAboveTheirHorizonAndReceiversAreChosen) {
  // The floor is the larger object and so the receiver; the ball shades it and not itself.
  const Stage stage(ball(0.5), 48, 48, light_samples(1));
  const Run found = soft(stage, {{"receiverSize", "64"}});
  std::size_t lit = 0, half = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!on_object(stage, i, 1)) continue;
    const glm::dvec3 p = stage.samples.p[i], n = stage.samples.n[i];
    double above = 0;
    for (int k = 0; k < 10000; ++k) {
      const int column = k % 100, row = k / 100;
      const glm::dvec3 l =
          glm::dvec3(stage.light.center) + glm::dvec3((column + 0.5) / 100 - 0.5, 0, (row + 0.5) / 100 - 0.5);
      above += glm::dot(n, l - p) > 0 ? 1e-4 : 0;
    }
    EXPECT_NEAR(static_cast<double>(found.picture.visibility[i]), above, 0.008);
    (above > 0.9999 ? lit : half) += 1;
  }
  EXPECT_GT(lit, 20U);
  EXPECT_GT(half, 5U);
  // A table that receives but does not cast is the receiver, however small; the floor then shades it.
  scenes::Scene table = ball(0.5);
  add_quad(table, {0, -1, 0}, {0.5, 0, 0}, {0, 0, 0.5}).casts_shadow = false;
  table.cameras.front() = camera({0, -0.5, 1.5}, {0, -1, 0}, 60);
  const Stage below(table, 16, 16, light_samples(1));
  const Run under = soft(below, {{"receiverSize", "64"}});
  std::size_t dark = 0;
  for (std::size_t i = 0; i < below.samples.size(); ++i) {
    if (!on_object(below, i, 2)) continue;
    EXPECT_LT(under.picture.visibility[i], 0.1F);  // the floor's map has gaps where the sphere hides the floor
    ++dark;
  }
  EXPECT_GT(dark, 5U);
}

// With self=backproject another method computes the pixels that the paper does not cover: occluders have that method's
// bytes, other pixels this method's own.
TEST_F(SoftShadowMap, OnOccludersBackprojectMayAnswer) {
  scenes::Scene scene = ball(0.5);
  add_quad(scene, {0.3, 3.6, 0.3}, {0.4, 0, 0}, {0, 0, 0.4});  // shades the ball
  const Stage stage(scene, 32, 32, light_samples(1));
  const MethodOptions small{{"size", "64"}, {"receiverSize", "64"}};
  MethodOptions answered = small;
  answered["self"] = "backproject";
  const Run alone = soft(stage, small), both = soft(stage, answered), tiled = soft(stage, answered, 5);
  const Masks other = run(maps::make_backproject, stage, {{"size", "64"}});
  std::size_t shaded = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const bool on_occluder = on_object(stage, i, 1) || on_object(stage, i, 2);
    EXPECT_EQ(both.picture.visibility[i], on_occluder ? other.visibility[i] : alone.picture.visibility[i]);
    shaded += on_occluder && other.visibility[i] != alone.picture.visibility[i] ? 1 : 0;
  }
  EXPECT_GT(shaded, 5U);
  EXPECT_EQ(tiled.picture.visibility, both.picture.visibility);
}

// A plate of half-size 1 at a small gap g above the floor, at depth 5 − g of 5. Each of its 64 texels is 2 / 64 (5 − g)
// wide, and the bias forgives that width times 5 and times the number of texels.
TEST_F(SoftShadowMap, TheBiasForgivesSoManyTexels) {
  constexpr double kTexels = 3;
  for (const double share : {0.985, 1.015}) {
    const double gap = (5 - std::sqrt(25 - 4 * share * kTexels * 5 * 2 / 64)) / 2;
    scenes::Scene scene = floor_and_light(0.5);
    scene.objects[0].casts_shadow = false;
    add_quad(scene, {0, gap, 0}, {1, 0, 0}, {0, 0, 1});
    const Stage stage = on_floor(scene, {{0, 0}, {0.3, 0.2}});
    for (const char* form : {"gather", "scatter"}) {
      const MethodOptions options{
          {"size", "66"}, {"receiverSize", "128"}, {"filter", "nearest"}, {"bias", "3"}, {"form", form}};
      for (const float v : soft(stage, options).picture.visibility) EXPECT_EQ(v, share < 1 ? 1.0F : 0.0F) << form;
    }
  }
}

TEST_F(SoftShadowMap, WhereOccludersHaveNoShadowsItSaysSo) {
  const auto warning = [](const Stage& stage, MethodOptions options) {
    options["size"] = options["receiverSize"] = "16";
    const auto method = maps::make_soft_shadow_map(device(), options);
    run(*method, stage);
    return maps::soft_shadow_map_description().warning(options, method->counters()).value_or("");
  };
  const Stage stage(ball(0.5), 16, 16, light_samples(1));
  EXPECT_NE(warning(stage, {}).find("self=backproject"), std::string::npos);
  EXPECT_EQ(warning(stage, {{"self", "backproject"}}), "");
  EXPECT_EQ(warning(on_floor(ball(0.5), {{0, 0}, {1, 0}}), {}), "") << "no pixel shows the ball";
}

/// An object without area that casts nothing must not become the receiver that all others shade.
TEST_F(SoftShadowMap, WhatIsNowhereDecidesNothing) {
  scenes::Scene with = ball(0.5);
  add_object(with, "line", {{glm::dvec3(0), glm::dvec3(0.25), glm::dvec3(0.5)}}).casts_shadow = false;
  const Stage plain(ball(0.5), 16, 16, light_samples(1)), same(with, 16, 16, light_samples(1));
  EXPECT_EQ(soft(same).picture.visibility, soft(plain).picture.visibility);
}

TEST_F(SoftShadowMap, DegenerateScenesHaveADefinedV) {
  scenes::Scene nothing = floor_and_light(0.5), crossing = ball(0.5), touching = floor_and_light(0.5), inside,
                room = ball(0.5);
  add_quad(crossing, {0.5, 5, 0}, {0, 1, 0}, {0, 0, 1});   // through the light
  add_quad(touching, {0, 1e-6, 0}, {1, 0, 0}, {0, 0, 1});  // on the receiver
  add_object(inside, "sphere", sphere({0, 0, 0}, 2, 8));   // around light and camera
  inside.lights.push_back(ceiling_light(0, 0.5));
  inside.lights.back().two_sided = true;
  inside.cameras.push_back(camera({0.5, 0.5, 0.5}, {0, -1, 0}, 90));
  add_quad(room, {4, 6, 0}, {0, 6, 0}, {0, 0, 6});  // a wall that reaches above the light, larger than the floor
  for (const scenes::Scene& scene : {nothing, crossing, touching, inside, room}) {
    const Stage stage(scene, 16, 16, light_samples(1));
    for (const char* size : {"8", "48"}) {
      for (const char* precision : {"fp16", "fp32"}) {
        const Run found =
            soft(stage, {{"size", size}, {"receiverSize", size}, {"passes", "2"}, {"precision", precision}});
        for (const float v : found.picture.visibility) EXPECT_TRUE(v >= 0 && v <= 1) << v;
      }
    }
  }
  const Stage stage(nothing, 16, 16, light_samples(1));
  for (const float v : soft(stage).picture.visibility) EXPECT_EQ(v, 1.0F) << "no occluder";
  scenes::Scene bulb = ball(0.5);
  bulb.lights.front().shape = scenes::Sphere{{0, 5, 0}, 0.5};
  const Stage round(bulb, 8, 8, light_samples(1));
  const auto method = maps::make_soft_shadow_map(device(), {});
  method->prepare_mesh(round.floats);
  EXPECT_THROW(method->prepare_light(round.light), InputError);
}

// Figure 11b: one pass with the bottom patches, the farthest surfaces of casters. Two passes take the smaller V of
// both.
TEST_F(SoftShadowMap, BottomPatchesAreTheSecondPassAlone) {
  const Stage stage = tests::on_floor(box_over_floor(0.3), 16, light_samples(1));
  const MethodOptions options{{"size", "48"}, {"receiverSize", "48"}, {"filter", "nearest"}};
  const auto with = [&](const char* key, const char* value) {
    MethodOptions more = options;
    more[key] = value;
    return soft(stage, more).picture.visibility;
  };
  const std::vector<float> top = with("patches", "top"), bottom = with("patches", "bottom"), both = with("passes", "2");
  std::size_t differing = 0;
  for (std::size_t i = 0; i < top.size(); ++i) {
    EXPECT_EQ(both[i], std::min(top[i], bottom[i])) << i;
    differing += std::abs(top[i] - bottom[i]) > 0.01F ? 1 : 0;
  }
  EXPECT_GT(differing, 10U);
  EXPECT_THROW(soft(stage, {{"passes", "2"}, {"patches", "bottom"}}), UsageError);
  EXPECT_THROW(soft(stage, {{"depth", "second"}, {"patches", "bottom"}}), UsageError);
}

}  // namespace
}  // namespace penumbra::tests
