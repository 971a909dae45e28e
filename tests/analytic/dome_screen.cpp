// SPDX-License-Identifier: Apache-2.0
// ssao and hbao against what they give by hand: on planes, at the bottom of valleys and beside a wall; and what they
// refuse.

#include "maps/screen/methods.hpp"
#include "tests/unit/dome_stage.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace penumbra::tests {
namespace {

using visibility::MethodOptions;

std::vector<float> visibility_of(const std::unique_ptr<visibility::Method>& method, const Stage& stage) {
  return answer_of(*method, stage).masks.visibility;
}

/// Two planes, 8 long, that rise by `left` and `right` (radians) on either side of the line x = 0, seen from above.
Stage valley(double left, double right, double height_seen = 4) {
  scenes::Scene scene;
  const glm::dvec3 to_left(-2 * std::cos(left), 2 * std::sin(left), 0),
      to_right(2 * std::cos(right), 2 * std::sin(right), 0);
  add_quad(scene, to_left, to_left, {0, 0, 4});
  add_quad(scene, to_right, to_right, {0, 0, 4});
  scene.lights.push_back(dome_light());
  scene.cameras.push_back(camera({0, 9, 0.0}, {0, 0, 0}));
  scene.cameras.back().up = {0, 0, -1};
  scene.cameras.back().height = height_seen;
  return {scene, 128, 128, light_samples(16)};
}

/// The option `radius` for this length.
std::string radius(const Stage& stage, double length) {
  const double diagonal = glm::length(glm::dvec3(stage.floats.upper) - glm::dvec3(stage.floats.lower));
  return fmt::format("{:.17g}", length / diagonal);
}

/// The mean over the middle rows of the pixel column that begins at x = 0.
double at_the_bottom(const std::vector<float>& visibility, std::size_t width) {
  double sum = 0;
  for (std::size_t y = width / 4; y < 3 * width / 4; ++y) sum += static_cast<double>(visibility[y * width + width / 2]);
  return sum / static_cast<double>(width / 2);
}

TEST(ScreenOcclusion, APlaneShadesNothing) {
  const Stage level = valley(0, 0);
  for (const char* dither : {"on", "off"}) {
    for (const float v : visibility_of(maps::make_ssao({{"dither", dither}}), level)) ASSERT_EQ(v, 1);
    for (const float v : visibility_of(maps::make_hbao({{"dither", dither}, {"angleBias", "0"}}), level))
      ASSERT_NEAR(v, 1, 1e-6);
  }
  // Tilted, and in perspective: horizons are the plane's own; of a ball pixels' depths cut off other halves.
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {40, 0, 0}, {0, 0, 40});
  scene.lights.push_back(dome_light());
  scene.cameras.push_back(camera({0.3, 6, 4}, {0.1, 0, 0.2}, 50));
  const Stage tilted(scene, 96, 96, light_samples(16));
  for (const float v : visibility_of(maps::make_hbao({{"angleBias", "0"}, {"radius", "0.02"}}), tilted))
    ASSERT_NEAR(v, 1, 1e-5);
  for (const char* around : {"ball", "hemisphere"}) {
    for (const float v :
         visibility_of(maps::make_ssao({{"around", around}, {"samples", "256"}, {"radius", "0.02"}}), tilted))
      ASSERT_GT(v, 0.94) << around;
  }
}

/// At the bottom of a valley of angle φ a ball is free in φ/2π of it, so V = φ/π; and the directions between the
/// horizons are as many, at half a pixel from it a little more. Light comes by the cosine: the exact V is (1 − cos
/// φ)/2.
TEST(ScreenOcclusion, AValleyIsFreeByItsAngle) {
  for (const auto& [left, right] : {std::pair(45.0, 45.0), std::pair(0.0, 45.0), std::pair(20.0, 60.0)}) {
    const double angle = 180 - left - right;
    const Stage stage = valley(glm::radians(left), glm::radians(right));
    const MethodOptions common{{"radius", radius(stage, 0.9)}, {"dither", "off"}};
    MethodOptions options = common;
    options["samples"] = "512";
    EXPECT_NEAR(at_the_bottom(visibility_of(maps::make_ssao(options), stage), 128), angle / 180, 0.035) << angle;
    options["around"] = "hemisphere";
    EXPECT_NEAR(at_the_bottom(visibility_of(maps::make_ssao(options), stage), 128), angle / 180, 0.035) << angle;
    options = common;
    options.insert({{"directions", "32"}, {"steps", "16"}, {"angleBias", "0"}, {"attenuation", "none"}});
    EXPECT_NEAR(at_the_bottom(visibility_of(maps::make_hbao(options), stage), 128), angle / 180, 0.035) << angle;
    // Dithered, few samples say the same on the whole.
    EXPECT_NEAR(at_the_bottom(visibility_of(maps::make_ssao({{"radius", radius(stage, 0.9)}}), stage), 128),
                angle / 180, 0.08)
        << angle;
  }
}

/// A wall at a right angle, δ radii away, takes a cap of the ball off, half of which is above the floor: V = 1 −
/// (2 − 3δ + δ³)/4.
TEST(ScreenOcclusion, AWallTakesACapOfTheBall) {
  const double slope = std::numbers::pi / 4;
  const Stage stage = valley(slope, slope);
  const std::vector<float> found =
      visibility_of(maps::make_ssao({{"radius", radius(stage, 0.8)}, {"samples", "2048"}, {"dither", "off"}}), stage);
  for (std::size_t column = 64; column < 100; column += 5) {
    double mean = 0;
    for (std::size_t y = 32; y < 96; ++y) mean += static_cast<double>(found[y * 128 + column]) / 64;
    const glm::dvec3 p = glm::dvec3(stage.samples.p[64 * 128 + column]) + stage.floats.origin;
    const double away = std::min(std::hypot(p.x, p.y) / 0.8, 1.0);
    EXPECT_NEAR(mean, 1 - (2 - 3 * away + away * away * away) / 4, 0.03) << away;
  }
}

/// The weight of a horizon falls off with the distance of its cause: at the bottom of a valley the first step, at a
/// share s of the radius, raises the whole horizon.
TEST(ScreenOcclusion, HorizonsCountByTheirDistance) {
  const double slope = std::numbers::pi / 4;
  const Stage stage = valley(slope, slope);
  MethodOptions options{
      {"radius", radius(stage, 1.1)}, {"dither", "off"}, {"directions", "64"}, {"steps", "1"}, {"angleBias", "0"}};
  // One step, as far as the radius in the picture: on the other side it is farther than the radius in space.
  const double none = at_the_bottom(visibility_of(maps::make_hbao(options), stage), 128);
  options["steps"] = "4";
  const double linear = at_the_bottom(visibility_of(maps::make_hbao(options), stage), 128);
  options["attenuation"] = "quadratic";
  const double quadratic = at_the_bottom(visibility_of(maps::make_hbao(options), stage), 128);
  options["attenuation"] = "none";
  const double whole = at_the_bottom(visibility_of(maps::make_hbao(options), stage), 128);
  EXPECT_GT(none, 0.9);
  // A quarter of the radius across; up the slope √2 as much, along the valley no rise.
  EXPECT_GT(linear, quadratic);
  EXPECT_GT(quadratic, whole);
  EXPECT_NEAR(whole, 0.5, 0.03);
  EXPECT_NEAR(1 - linear, 0.5 * (1 - 0.25 * 1.3), 0.05);
}

/// A ball in front of a far plane darkens it, as published; not where hiding has a range.
TEST(ScreenOcclusion, RimsBehindObjectsAreThePapers) {
  scenes::Scene scene;
  add_quad(scene, {0, 0, 0}, {4, 0, 0}, {0, 0, 4});
  add_quad(scene, {0, 3, 0}, {0.5, 0, 0}, {0, 0, 0.5});
  scene.lights.push_back(dome_light());
  scene.cameras.push_back(camera({0, 9, 0}, {0, 0, 0}));
  scene.cameras.back().up = {0, 0, -1};
  scene.cameras.back().height = 4;
  const Stage stage(scene, 64, 64, light_samples(16));
  const MethodOptions rim{{"radius", radius(stage, 0.6)}, {"samples", "256"}, {"dither", "off"}};
  MethodOptions none = rim;
  none["range"] = "on";
  const std::vector<float> dark = visibility_of(maps::make_ssao(rim), stage),
                           light = visibility_of(maps::make_ssao(none), stage);
  const std::size_t beside = 32 * 64 + 32 + 9;  // 0.06 beyond the square
  EXPECT_LT(dark[beside], 0.75);
  EXPECT_EQ(light[beside], 1);
}

TEST(ScreenOcclusion, TilesAndRefusals) {
  const Stage stage = valley(0.2, 0.7);
  for (const auto& make : {maps::make_ssao, maps::make_hbao}) {
    const auto method = make({});
    const std::vector<float> whole = visibility_of(method, stage);
    std::vector<float> part(3 * 128);
    method->evaluate({0, 3});
    method->evaluate({40, 3});
    method->read_visibility(part);
    EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin() + 40 * 128));

    Stage lamp = stage;
    lamp.light = visibility::make_light(
        [] {
          scenes::Scene scene;
          scene.lights.push_back(ceiling_light(2, 0.5));
          return scene;
        }(),
        0, glm::dvec3(0), light_samples(4));
    EXPECT_THROW(visibility_of(method, lamp), InputError);
    Stage baked = stage;
    for (glm::vec3& p : baked.samples.p) p.x += 1;
    EXPECT_THROW(visibility_of(method, baked), InputError);
    EXPECT_THROW(std::ignore = make({{"radius", "0"}}), UsageError);
  }
}

}  // namespace
}  // namespace penumbra::tests
