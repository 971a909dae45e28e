// SPDX-License-Identifier: Apache-2.0
// Tests ssao and hbao against values computed by hand (on planes, at the bottom of valleys and beside a wall), and what
// they refuse.

#include "maps/screen/methods.hpp"
#include "tests/unit/dome_stage.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
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

/// The value of the option `radius` for this length.
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
  // A tilted plane in perspective: hbao's horizons are the plane's own; ssao's pixel depths do not cut the ball exactly
  // in half.
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

constexpr double kPixel = 4.0 / 128;  // of valley()

/// Returns the height of a valley at x.
double height_at(double x, double left, double right) {
  return x < 0 ? -x * std::tan(left) : x * std::tan(right);
}

/// V of a ball around the valley's point at x, by volume. The cells of the plane across the valley are chosen so that
/// none lies on a diagonal.
double free_of_ball(double x, double radius, double left, double right) {
  constexpr int kAcross = 511, kUp = 508;
  double inside = 0, free = 0;
  const auto middle = [](int i, int cells) { return (2 * i + 1.0) / cells - 1; };
  for (int i = 0; i < kAcross; ++i) {
    for (int k = 0; k < kUp; ++k) {
      const double across = middle(i, kAcross), up = middle(k, kUp), rest = 1 - across * across - up * up;
      if (rest <= 0) continue;
      const double along = std::sqrt(rest);  // the valley is level along its own direction
      inside += along;
      const double there = height_at(x + radius * across, left, right);
      if (height_at(x, left, right) + radius * up >= there) free += along;
    }
  }
  return std::min(1.0, 2 * free / inside);
}

/// Error of N points that fill a ball evenly. About N^2/3 of them are within the distance of neighbours from a face of
/// the free part, and about the square root of that number is on the wrong side: a share of N^-2/3 of all. V is twice
/// the share.
double off_of_points(double count) {
  return 2 * std::pow(count, -2.0 / 3);
}

struct Search {
  int directions = 32, steps = 16;
  double pixel = 0;  ///< if not 0, samples are at the centres of pixels this wide
  std::function<double(double)> weight = [](double) { return 1.0; };
};

/// Returns 1 minus the mean, over directions, of the horizon's rise above the tangent; horizons are found at `steps`
/// places.
double below_horizons(double x, double radius, const glm::dvec2& slopes, const Search& search) {
  const auto height = [&](double at) { return height_at(at, slopes.x, slopes.y); };
  const auto to_centre = [&](double to) {  // from the centre of the receiver's pixel
    return search.pixel > 0 ? search.pixel * std::floor(to / search.pixel + 0.5) : to;
  };
  double hidden = 0;
  for (int k = 0; k < search.directions; ++k) {
    const double turn = 2 * std::numbers::pi * k / search.directions;
    double horizon = -1;
    for (int step = 1; step <= search.steps; ++step) {
      const double far = radius * step / search.steps;
      const double across = to_centre(far * std::cos(turn)), along = to_centre(far * std::sin(turn));
      const double rise = height(x + across) - height(x), away = std::hypot(across, along, rise);
      if (away == 0 || away >= radius) continue;
      const double tangent = std::tan(slopes.y) * across;  // of the receiver's own plane
      const double base = std::max(horizon, tangent / std::hypot(across, along, tangent));
      if (rise / away <= base) continue;
      hidden += search.weight(away / radius) * (rise / away - base);
      horizon = rise / away;
    }
  }
  return 1 - hidden / search.directions;
}

/// At the bottom of a valley of angle φ, φ/2π of a ball is free, so V = φ/π; φ/π is also the share of the directions
/// between the horizons. The exact V, weighted by the cosine, is (1 − cos φ)/2. Pixels' centres are half a pixel from
/// the bottom, and horizons are those of pixels' centres.
TEST(ScreenOcclusion, AValleyIsFreeByItsAngle) {
  for (const auto& [left, right] : {std::pair(45.0, 45.0), std::pair(0.0, 45.0), std::pair(20.0, 60.0)}) {
    const double angle = 180 - left - right, radius_seen = 0.9;
    const glm::dvec2 slopes(glm::radians(left), glm::radians(right));
    const auto free = [&](double x) { return free_of_ball(x, radius_seen, slopes.x, slopes.y); };
    EXPECT_NEAR(free(0), angle / 180, 1e-3);  // the error is half a cell along the faces
    const Stage stage = valley(slopes.x, slopes.y);
    const MethodOptions common{{"radius", radius(stage, radius_seen)}, {"dither", "off"}};
    MethodOptions options = common;
    options["samples"] = "1024";
    const double near = free(kPixel / 2), off = off_of_points(1024);
    EXPECT_NEAR(at_the_bottom(visibility_of(maps::make_ssao(options), stage), 128), near, off) << angle;
    options["around"] = "hemisphere";
    EXPECT_NEAR(at_the_bottom(visibility_of(maps::make_ssao(options), stage), 128), near, off) << angle;
    options = common;
    options.insert({{"directions", "32"}, {"steps", "16"}, {"angleBias", "0"}, {"attenuation", "none"}});
    EXPECT_NEAR(below_horizons(1e-9, radius_seen, slopes, {.directions = 4096}), angle / 180, 1e-3);
    EXPECT_NEAR(at_the_bottom(visibility_of(maps::make_hbao(options), stage), 128),
                below_horizons(kPixel / 2, radius_seen, slopes, {.pixel = kPixel}), 1e-5)
        << angle;
    // With dithering, few samples give the same mean: 16 at each of the 4 × 4 pixels that are averaged.
    double mean = 0;
    for (const double x : {-1.5, -0.5, 0.5, 1.5}) mean += free(x * kPixel) / 4;
    EXPECT_NEAR(at_the_bottom(visibility_of(maps::make_ssao({{"radius", radius(stage, radius_seen)}}), stage), 128),
                mean, off_of_points(16 * 16))
        << angle;
  }
}

/// A wall at a right angle, δ radii away, cuts a cap off the ball, half of which is above the floor: V = 1 − (2 − 3δ +
/// δ³)/4.
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
    EXPECT_NEAR(mean, 1 - (2 - 3 * away + away * away * away) / 4, off_of_points(2048)) << away;
  }
}

/// The weight of a horizon falls off with the distance of its cause. At the bottom of a valley the first step, at a
/// share s of the radius, raises the whole horizon.
TEST(ScreenOcclusion, HorizonsCountByTheirDistance) {
  const double slope = std::numbers::pi / 4, radius_seen = 1.1;
  const Stage stage = valley(slope, slope);
  MethodOptions options{{"radius", radius(stage, radius_seen)},
                        {"dither", "off"},
                        {"directions", "64"},
                        {"steps", "1"},
                        {"angleBias", "0"}};
  // One step, a whole radius away in the picture: on the other slope that is farther than the radius in space.
  EXPECT_GT(at_the_bottom(visibility_of(maps::make_hbao(options), stage), 128), 0.9);
  options["steps"] = "4";
  const auto check = [&](const char* attenuation, const std::function<double(double)>& weight) {
    options["attenuation"] = attenuation;
    EXPECT_NEAR(at_the_bottom(visibility_of(maps::make_hbao(options), stage), 128),
                below_horizons(kPixel / 2, radius_seen, {slope, slope}, {64, 4, kPixel, weight}), 1e-5)
        << attenuation;
  };
  check("linear", [](double share) { return 1 - share; });
  check("quadratic", [](double share) { return 1 - share * share; });
  check("none", [](double) { return 1.0; });
}

/// A square in front of a far plane darkens the plane around it, as in the published method; with the option `range` it
/// does not.
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
  const std::size_t beside = 32 * 64 + 32 + 9;  // 0.06 outside the square
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
