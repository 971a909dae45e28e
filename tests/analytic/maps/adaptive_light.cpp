// SPDX-License-Identifier: Apache-2.0
// Tests adaptive-light's V against accumulate on the same points, and against areas in closed form.

#include "tests/analytic/maps/adaptive_light.hpp"
#include "tests/analytic/maps/parallel_square.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <set>

namespace penumbra::tests {
namespace {

TEST_F(AdaptiveLight, WithoutToleranceIsAccumulateOverTheCornersOfAllCells) {
  scenes::Scene disk = sphere_scene(0.5), polygon = sphere_scene(0.5), room = sphere_scene(0.5),
                both = sphere_scene(0.5);
  disk.lights.front().shape = scenes::Disk{{0, 5, 0}, {0, -1, 0}, 0.5};
  polygon.lights.front().shape = scenes::Polygon{{{-0.6, 5, -0.5}, {0.5, 5, -0.4}, {0.2, 5, 0.6}}};
  add_quad(room, {4, 3, 0}, {0, 3, 0}, {0, 0, 4});  // reaches above the light, so that its maps are hemicubes
  add_quad(both, {0, 9, 0}, {3, 0, 0}, {0, 0, 3});
  both.lights.front().two_sided = true;
  scenes::Scene ellipse = sphere_scene(0.5);
  ellipse.lights.front().shape = scenes::Ellipse{{0, 5, 0}, {0.6, 0, 0}, {0.1, 0, 0.3}};
  for (const scenes::Scene& scene : {sphere_scene(0.5), disk, ellipse, polygon, room, both}) {
    Stage stage(scene, 32, 32, light_samples(4));
    const Run all = adaptive(stage, {{"levels", "2"}, {"epsilon", "0"}, {"pcf", "off"}, {"size", "64"}});
    EXPECT_EQ(all.maps, 25U);
    EXPECT_EQ(all.comparisons, 2U + 8U);
    stage.light = with_points(stage.light, corner_grid(stage.light, 5));
    const Masks accumulated = run(maps::make_accumulate, stage, {{"size", "64"}});
    EXPECT_EQ(all.picture.visibility, accumulated.visibility);
    EXPECT_GT(std::set<float>(all.picture.visibility.begin(), all.picture.visibility.end()).size(), 10U);
  }
}

TEST_F(AdaptiveLight, OnALineIsAccumulateOverItsPoints) {
  scenes::Scene scene = sphere_scene(0.5);
  scene.lights.front() = rectangle_light({0, 5, 0}, {0.1, 0, 0}, {0, 0, 0.8});  // v is the longer axis
  Stage stage(scene, 32, 32, light_samples(4));
  const Run all = adaptive(stage, {{"levels", "3"}, {"epsilon", "0"}, {"pcf", "off"}, {"form", "line"}});
  EXPECT_EQ(all.maps, 9U);
  EXPECT_EQ(all.comparisons, 1U + 2U + 4U);
  std::vector<glm::vec3> points;
  const maps::LightSquare square(stage.light);
  for (int i = 0; i < 9; ++i) points.push_back(square.at({0.5, i / 8.0}));
  stage.light = with_points(stage.light, points);
  EXPECT_EQ(all.picture.visibility, run(maps::make_accumulate, stage, {{"size", "128"}}).visibility);
  EXPECT_EQ(adaptive(stage, {{"levels", "3"}, {"epsilon", "1"}, {"form", "line"}}).maps, 2U);
}

// Row D4 of docs/predicates.md: with equal weights, the outermost of n points in a row count as much as all others,
// though they stand for half as much of the light. Over the penumbra of a straight edge V is a ramp; n points give
// steps instead, whose root mean square error follows in closed form.
TEST_F(AdaptiveLight, CornersAreNotTheLightsMean) {
  scenes::Scene scene = bare_floor(1, 1.5);
  scene.lights.front() = rectangle_light({0, 5, 0}, {1, 0, 0}, {0, 0, 0.001});
  add_quad(scene, {1.5, 2.5, 0}, {1.5, 0, 0}, {0, 0, -1}).receives_shadow = false;  // occupies x > 0
  constexpr int kPlaces = 400;
  std::vector<double> places;
  for (int i = 0; i < kPlaces; ++i) places.push_back(-1 + (2 * i + 1.0) / kPlaces);
  const Stage stage = along_floor(scene, places, {9, 1, 9, visibility::SamplePattern::grid, 0});
  const auto off = [&](const std::function<double(std::size_t)>& v) {
    double sum = 0;
    for (std::size_t i = 0; i < places.size(); ++i) sum += std::pow(v(i) - (1 - places[i]) / 2, 2);
    return std::sqrt(sum / kPlaces);
  };
  // V of nine points from -1 to 1, each with its weight; those at less than -x are visible.
  const auto steps = [&](const std::function<double(int)>& weight, const std::function<double(int)>& at) {
    return off([&](std::size_t i) {
      double v = 0;
      for (int k = 0; k < 9; ++k) v += at(k) < -places[i] ? weight(k) : 0.0;
      return v;
    });
  };
  const auto corner = [](int k) { return -1 + k / 4.0; };
  const auto ninth = [](int /*k*/) { return 1.0 / 9; };
  const double equal = steps(ninth, corner),
               trapezoid = steps([](int k) { return k % 8 == 0 ? 1.0 / 16 : 1.0 / 8; }, corner),
               cells = steps(ninth, [](int k) { return -1 + (2 * k + 1) / 9.0; });
  EXPECT_NEAR(equal, 0.0481, 1e-4);
  EXPECT_NEAR(trapezoid, 0.0361, 1e-4);
  EXPECT_NEAR(cells, 0.0321, 1e-4);
  const auto found = [&](const char* weights) {
    const Run nine = adaptive(
        stage,
        {{"form", "line"}, {"levels", "3"}, {"epsilon", "0"}, {"pcf", "off"}, {"weights", weights}, {"size", "2048"}});
    EXPECT_EQ(nine.maps, 9U);
    return off([&](std::size_t i) { return static_cast<double>(nine.picture.visibility[i]); });
  };
  const Masks accumulated = run(maps::make_accumulate, stage, {{"size", "2048"}});
  const double found_cells = off([&](std::size_t i) { return static_cast<double>(accumulated.visibility[i]); });
  fmt::print("nine points: equal {:.4f}, area {:.4f}, cells {:.4f}\n", found("equal"), found("area"), found_cells);
  // A step is off by half a texel, which is 1.2 / 2046 wide in the map and 2.5 · 2 times that on the floor, in a
  // penumbra 2 wide; the places are 1/200 apart. Where a step of 1/9 is off by d, V is wrong by 1/9 over the length d:
  // nine such steps move the mean square by 9 · 2 · the error there · d / 9.
  const double shift = 0.5 * 1.2 / 2046 * 5 + 1.0 / kPlaces, moved = 2 * (1.0 / 9) * shift;
  for (const auto& [measured, expected] :
       {std::pair(found("equal"), equal), {found("area"), trapezoid}, {found_cells, cells}}) {
    EXPECT_NEAR(measured * measured, expected * expected, moved);
    EXPECT_NEAR(measured, expected, 0.02 * expected);
  }
}

TEST_F(AdaptiveLight, WhatEveryPointSeesIsExactlyLitAndTilesChangeNothing) {
  const Stage stage(sphere_scene(0.5), 40, 40, light_samples(4));
  for (const char* weights : {"paper", "equal", "area"}) {
    for (const char* compare : {"camera", "light"}) {
      const MethodOptions options{{"weights", weights}, {"epsilon", "0.002"}, {"compare", compare}};
      const Run once = adaptive(stage, options), tiled = adaptive(stage, options, 7);
      EXPECT_EQ(once.picture.visibility, tiled.picture.visibility);
      EXPECT_EQ(once.maps, tiled.maps);
      std::size_t lit = 0, dark = 0;
      for (std::size_t i = 0; i < stage.samples.size(); ++i) {
        ASSERT_GE(once.picture.visibility[i], 0.0F);
        ASSERT_LE(once.picture.visibility[i], 1.0F);
        lit += once.picture.visibility[i] == 1.0F ? 1 : 0;
        dark += once.picture.visibility[i] == 0.0F ? 1 : 0;
      }
      EXPECT_GT(lit, stage.samples.size() / 4);
      EXPECT_GT(dark, 10U);
    }
  }
}

// Maps half as fine have filters twice as wide: the steps between few maps vanish, and the penumbra widens (section
// 3.4.3 of the paper).
TEST_F(AdaptiveLight, AWiderFilterSmoothsFewMapsAndWidensThePenumbra) {
  const Stage stage(sphere_scene(0.1), 96, 96, light_samples(1));
  const Masks truth = exact(stage);
  const auto penumbra = [&](const Masks& picture) {
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      pixels += on_floor(stage, i) && picture.visibility[i] > 0 && picture.visibility[i] < 1 ? 1 : 0;
    }
    return pixels;
  };
  std::size_t last = 0;
  double last_error = 0;
  for (const char* size : {"256", "64", "16"}) {
    const Run found = adaptive(stage, {{"epsilon", "1"}, {"size", size}});
    const std::size_t pixels = penumbra(found.picture);
    const double error = floor_rmse(stage, found.picture, truth);
    fmt::print("size {}: {} pixels of penumbra ({} exactly), RMSE {:.4f}\n", size, pixels, penumbra(truth), error);
    EXPECT_GT(pixels, last);
    EXPECT_GT(error, last_error);
    last = pixels;
    last_error = error;
  }
  EXPECT_GT(last, penumbra(truth));
}

// One map of a half-plane, from a point light. The filter is a square n - 1 texels wide around the receiver, in which
// each texel counts by its overlap. V is the part of this square beyond the edge, which the map places between two
// texels: over the floor, a ramp as wide as the square.
TEST_F(AdaptiveLight, AFilterOfNTexelsIsARampOfNLessOne) {
  scenes::Scene scene = bare_floor(1e-4, 1.5);
  add_quad(scene, {1.5, 2.5, 0}, {1.5, 0, 0}, {0, 0, -2}).receives_shadow = false;  // occupies x > 0
  constexpr int kPlaces = 256;
  std::vector<double> places;
  for (int i = 0; i < kPlaces; ++i) places.push_back(-0.6 + 1.2 * (i + 0.5) / kPlaces);
  const Stage stage = along_floor(scene, places, light_samples(1));
  for (const int n : {3, 4, 5, 9, 17}) {
    // The window holds the floor (tangents of 0.3 on either side) and the board within half a filter's width of it. The
    // width of its texels is found from the ramp; this is its upper bound.
    const Run found =
        adaptive(stage, {{"epsilon", "1"}, {"pcf", fmt::format("{}", n)}, {"size", "256"}, {"form", "line"}});
    std::vector<double> v(found.picture.visibility.begin(), found.picture.visibility.end());
    double from = 1, to = -1;  // the ramp's part between 1/8 and 7/8
    for (int i = 0; i < kPlaces; ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_LE(v[k], i > 0 ? v[k - 1] + 1e-6 : 1.0) << n;
      if (v[k] < 0.875) from = std::min(from, places[k]);
      if (v[k] > 0.125) to = std::max(to, places[k]);
    }
    const double width = (to - from) / 0.75, texel = width / (n - 1);  // on the floor
    fmt::print("{} texels: a ramp {:.3f} wide, of texels {:.4f} wide\n", n, width, texel);
    const double least = 2 * 1.5 / 256, most = least + 5 * 2.0 * 2 * 4 * (n / 2) / (256.0 * 256);
    EXPECT_GT(texel, least - 2 * 1.2 / kPlaces / (0.75 * (n - 1)));
    EXPECT_LT(texel, most + 2 * 1.2 / kPlaces / (0.75 * (n - 1)));
    for (int i = 0; i < kPlaces; ++i) {  // straight in between
      const auto k = static_cast<std::size_t>(i);
      const double expected = std::clamp(0.875 - (places[k] - from) / width, 0.0, 1.0);
      EXPECT_NEAR(v[k], expected, 2 * 1.2 / kPlaces / width + 1e-4) << n << " at " << places[k];
    }
  }
}

// Equation 3: differences of heights are relative to the heights, or to the whole range that a map can hold. A board 4
// below the light and a floor 5 below it differ by 1 / 5 or 1 / 4 of their heights, and by 1 / range, where the range
// is at least the distance from the light's corner to the floor's far corner.
TEST_F(AdaptiveLight, GammaIsAShareOfHeightsOrOfAMapsRange) {
  scenes::Scene scene = bare_floor(1, 1.5);
  scene.objects.front().casts_shadow = true;
  add_quad(scene, {1.5, 1, 0}, {1.5, 0, 0}, {0, 0, -2}).receives_shadow = false;
  const Stage stage = tests::on_floor(scene, 24, light_samples(1));
  const auto maps = [&](const char* of, double gamma) {
    return adaptive(stage, {{"gammaOf", of}, {"gamma", fmt::format("{}", gamma)}, {"epsilon", "0.0001"}}).maps;
  };
  const std::uint64_t few = maps("height", 0.3), many = maps("height", 0.1);
  fmt::print("maps: {} and {}\n", few, many);
  EXPECT_EQ(few, 4U);
  EXPECT_GT(many, few);
  const double range = std::sqrt(5 * 5 + 2 * 2.5 * 2.5);  // a map's range is at least this
  EXPECT_EQ(maps("range", 0.05), many);
  EXPECT_EQ(maps("height", 0.195), many);
  EXPECT_EQ(maps("range", 1 / range + 0.001), few);
  EXPECT_LT(1 / range + 0.001, 0.195);
}

// An edge under one side of the light refines only that side: with equal weights, that side then counts too much.
TEST_F(AdaptiveLight, ThePapersWeightsAreNearerToTheTruthThanEqualOnes) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {0.4, 0, 0}, {0, 0, -0.4});
  // Seen from the floor's middle, the board hides the light beyond x = 0.8; the light ends at x = 1.
  add_quad(scene, {4.4, 2.5, 0}, {4, 0, 0}, {0, 0, 6}).receives_shadow = false;
  scene.lights.push_back(ceiling_light(5, 1));
  scene.cameras.push_back(camera({0, 1.5, 0}, {0, 0, -0.001}, 20));
  const Stage stage(scene, 32, 32, light_samples(1));
  const Masks truth = exact(stage);
  const auto bias = [&](const char* weights) {
    const Run found =
        adaptive(stage, {{"weights", weights}, {"levels", "4"}, {"epsilon", "0.3"}, {"shareOf", "pixels"}});
    double sum = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      sum += static_cast<double>(found.picture.visibility[i]) - static_cast<double>(truth.visibility[i]);
    }
    fmt::print("{}: {} maps, bias {:+.4f}\n", weights, found.maps, sum / static_cast<double>(stage.samples.size()));
    return std::abs(sum);
  };
  const double paper = bias("paper"), equal = bias("equal"), area = bias("area");
  EXPECT_LT(paper, 0.5 * equal);
  EXPECT_LT(area, 0.5 * equal);
}

TEST_F(AdaptiveLight, ATextureWeighsTheMaps) {
  scenes::Scene scene = parallel_square(5, 6);  // a half-plane: its edge at x = 1, height 2
  scenes::Texture texture;
  texture.width = 2;
  texture.height = 1;
  texture.texels = {{0, 0, 0}, {1, 1, 1}};  // light from x > 0 alone
  scene.lights.front().texture = texture;
  const Stage stage(scene, 32, 32, light_samples(16));
  const Run found = adaptive(stage, {{"epsilon", "0"}, {"levels", "4"}, {"weights", "area"}});
  const ParallelSquare square(stage);
  double worst = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (!square.on_floor(i)) continue;
    // p sees the light beyond x_l = p.x + (1 - p.x) 5/2; the light's lit half is x_l from 0 to 1.
    const double x = static_cast<double>(stage.samples.p[i].x) + stage.floats.origin.x, edge = x + (1 - x) * 2.5;
    const double truth = 1 - std::clamp(edge, 0.0, 1.0);
    worst = std::max(worst, std::abs(static_cast<double>(found.picture.visibility[i]) - truth));
  }
  // The trapezoidal rule with 8 cells over the lit half is off by half a cell at the edge. The map adds half the width
  // of one of its texels, 2 . 5/3 / 2 of 8/126, on a light 1 wide.
  EXPECT_LT(worst, 0.5 / 8 + 0.5 * 8.0 / 126 * (5.0 / 3) + 0.02);
}

// Each point weighs a quarter of the light of each adjacent cell (on a line, half of it). For the expected weights the
// texture is cut into 12 x 20 pieces (on a line 3 x 40), of which both texels and cells hold whole numbers. The hard
// shadows must be accumulate's bits for the same points.
TEST_F(AdaptiveLight, TexturesWeighPointsByTheLightOfTheirCells) {
  for (const bool line : {false, true}) {
    scenes::Scene scene = sphere_scene(0.5);
    if (line) scene.lights.front() = rectangle_light({0, 5, 0}, {0.1, 0, 0}, {0, 0, 0.8});  // v is the longer axis
    scenes::Texture texture;
    texture.width = 3;
    texture.height = 5;
    for (int k = 0; k < 15; ++k) texture.texels.emplace_back(static_cast<float>(1 + k * k % 11));
    scene.lights.front().texture = texture;
    Stage stage(scene, 32, 32, light_samples(4));
    const visibility::LightTexture found = *stage.light.texture;
    const Run textured = adaptive(stage, {{"levels", line ? "3" : "2"},
                                          {"form", line ? "line" : "area"},
                                          {"weights", "area"},
                                          {"epsilon", "0"},
                                          {"pcf", "off"},
                                          {"size", "64"}});
    const int across = line ? 1 : 5, down = line ? 9 : 5, columns = line ? 3 : 12, rows = line ? 40 : 20;
    std::vector<double> weights(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), 0.0);
    double whole = 0;
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const int texel = (4 - y * 5 / rows) * 3 + x * 3 / columns;
        const double light = found.luminance[static_cast<std::size_t>(texel)];
        whole += light;
        const int row = y * (down - 1) / rows, column = line ? 0 : x * 4 / columns;
        for (int k = 0; k < (line ? 2 : 4); ++k) {
          const int point = (row + (line ? k : k / 2)) * across + (line ? 0 : column + k % 2);
          weights[static_cast<std::size_t>(point)] += light / (line ? 2 : 4);
        }
      }
    }
    std::vector<glm::vec3> points;
    const maps::LightSquare square(stage.light);
    for (int y = 0; y < down; ++y) {
      for (int x = 0; x < across; ++x) {
        points.push_back(square.at({line ? 0.5 : x / 4.0, y / (down - 1.0)}));
      }
    }
    stage.light = with_points(stage.light, points);
    stage.light.weights.clear();
    stage.light.texture.reset();
    const Masks bits = run(maps::make_accumulate, stage, {{"size", "64"}});
    std::size_t between = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      double v = 0;
      for (std::uint32_t j = 0; j < points.size(); ++j) v += bits.visible(i, j) ? weights[j] / whole : 0.0;
      EXPECT_NEAR(textured.picture.visibility[i], v, 1e-5) << i;
      between += v > 0 && v < 1 ? 1 : 0;
    }
    EXPECT_GT(between, 30U);
  }
}

TEST_F(AdaptiveLight, DegenerateScenesHaveADefinedV) {
  scenes::Scene nothing = parallel_square(), crossing = parallel_square(), inside;
  nothing.objects[1].casts_shadow = nothing.objects[0].casts_shadow = false;
  add_quad(crossing, {0.5, 5, 0}, {0, 1, 0}, {0, 0, 1});  // through the light
  add_object(inside, "sphere", sphere({0, 0, 0}, 2, 8));  // around light and camera
  inside.lights.push_back(ceiling_light(0, 0.5));
  inside.lights.back().two_sided = true;
  inside.cameras.push_back(camera({0.5, 0.5, 0.5}, {0, -1, 0}, 90));
  for (const scenes::Scene& scene : {nothing, crossing, inside}) {
    const Stage stage(scene, 16, 16, light_samples(1));
    for (const char* size : {"8", "100"}) {
      for (const char* compare : {"camera", "light"}) {
        const Run found = adaptive(stage, {{"size", size}, {"compare", compare}});
        for (const float v : found.picture.visibility) EXPECT_TRUE(v >= 0 && v <= 1) << v;
      }
    }
  }
  const Stage stage(nothing, 16, 16, light_samples(1));
  EXPECT_EQ(adaptive(stage, {}).maps, 4U) << "empty maps agree";
  EXPECT_THROW(maps::make_adaptive_light(device(), {{"levels", "9"}}), UsageError);
}

}  // namespace
}  // namespace penumbra::tests
