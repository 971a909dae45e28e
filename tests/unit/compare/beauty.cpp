// SPDX-License-Identifier: Apache-2.0
#include "compare/beauty.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <numbers>

namespace penumbra::compare {
namespace {

using visibility::Light;
using visibility::LightKind;
using visibility::SceneFloats;
using visibility::ViewSamples;

constexpr double kPi = std::numbers::pi;

/// A floor with one pixel and one triangle of object 0 at each of the given points, facing up, with colour (0.5, 0.25,
/// 1).
struct Floor {
  SceneFloats scene;
  ViewSamples samples;
  std::vector<glm::dvec3> colors{{0.5, 0.25, 1}};
  std::vector<Light> lights;

  explicit Floor(const std::vector<glm::vec3>& points) {
    samples.width = static_cast<std::uint32_t>(points.size());
    samples.height = 1;
    samples.p = points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      samples.triangle.push_back(static_cast<std::int32_t>(i));
      samples.n.emplace_back(0, 1, 0);
      scene.object.push_back(0);
      scene.receives_shadow.push_back(1);
      scene.emits.push_back(-1);
    }
  }
  [[nodiscard]] std::vector<glm::vec3> shade(std::vector<LightVisibility> seen) const {
    return integrate_beauty({scene, samples, colors, lights}, seen);
  }
};

/// Returns a horizontal rectangle at height y with half sides a along x and b along z, emitting down (or up), with rows
/// × columns samples at the centres of cells.
Light rectangle(float y, float a, float b, int rows, int columns, bool down = true) {
  Light light;
  light.area = 4.0 * static_cast<double>(a) * static_cast<double>(b);
  light.radiance = {10, 20, 30};
  light.center = {0, y, 0};
  light.center_u = {a, y, 0};
  light.center_v = {0, y, down ? b : -b};  // x × z points down
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double u = (2 * c + 1.0) / columns - 1, v = (2 * r + 1.0) / rows - 1;
      light.coordinates.emplace_back(u, v);
      light.points.emplace_back(static_cast<float>(u) * a, y, static_cast<float>(v) * light.center_v.z);
    }
  }
  return light;
}

/// Form factor of a surface element and a parallel rectangle a × b at distance c, one corner on the element's normal
/// (Siegel and Howell, configuration 3).
double corner_form_factor(double a, double b, double c) {
  const double x = a / c, y = b / c, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
}

/// Form factor of a square of half-size 1 at height 2.
const double kStraightAbove = 4 * corner_form_factor(1, 1, 2);

TEST(Beauty, OneSampleStraightAbove) {
  Floor floor({{0, 0, 0}});
  floor.lights = {rectangle(2, 1, 1, 1, 1)};
  const std::vector<std::uint32_t> seen{1}, hidden{0};
  // All of the light is visible: the light's form factor counts, not the sample's. colour · radiance · F
  const glm::vec3 color = floor.shade({{seen, {}}})[0];
  EXPECT_FLOAT_EQ(color.r, static_cast<float>(0.5 * 10 * kStraightAbove));
  EXPECT_FLOAT_EQ(color.g, static_cast<float>(0.25 * 20 * kStraightAbove));
  EXPECT_FLOAT_EQ(color.b, static_cast<float>(1 * 30 * kStraightAbove));
  EXPECT_EQ(floor.shade({{hidden, {}}})[0], glm::vec3(0));
}

TEST(Beauty, ALightToOneSide) {
  Floor floor({{3, 0, 0}});
  floor.lights = {rectangle(4, 1, 1, 1, 1)};
  const std::vector<std::uint32_t> seen{1};
  // The strip from 2 to 4 next to the element: the rectangle up to 4 minus the one up to 2, twice.
  const double expected = 2 * (corner_form_factor(4, 1, 4) - corner_form_factor(2, 1, 4));
  EXPECT_FLOAT_EQ(floor.shade({{seen, {}}})[0].r, static_cast<float>(0.5 * 10 * expected));
}

TEST(Beauty, IsTheRectanglesFormFactor) {
  // Points under the middle, and under the corner (±2, ±1): E = π · radiance · F, beauty = colour · radiance · F.
  Floor floor({{0, 0, 0}, {2, 0, 1}});
  floor.lights = {rectangle(3, 2, 1, 4, 8)};
  const std::vector<std::uint32_t> seen(2, 0xffffffffu);
  const auto colors = floor.shade({{seen, {}}});
  EXPECT_FLOAT_EQ(colors[0].r, static_cast<float>(0.5 * 10 * 4 * corner_form_factor(2, 1, 3)));
  EXPECT_FLOAT_EQ(colors[1].r, static_cast<float>(0.5 * 10 * corner_form_factor(4, 2, 3)));
}

TEST(Beauty, AMaskCountsItsOwnSamplesOnly) {
  // Two samples at x = ∓1 of a light 4 × 2 at height 2, seen from x = 1: d = (−2, 2, 0) and (0, 2, 0). Their
  // weights cos θp / d³ are in the proportion of 1/8² to 1/4²: 1 part and 4 parts of the whole light, which reaches 3
  // to one side of the element and 1 to the other.
  Floor floor({{1, 0, 0}});
  floor.lights = {rectangle(2, 2, 1, 1, 2)};
  const double whole = 0.5 * 10 * 2 * (corner_form_factor(3, 1, 2) + corner_form_factor(1, 1, 2));
  const std::vector<std::uint32_t> first{1}, second{2}, both{3}, beyond{0xfffffffcu};
  EXPECT_FLOAT_EQ(floor.shade({{first, {}}})[0].r, static_cast<float>(whole / 5));
  EXPECT_FLOAT_EQ(floor.shade({{second, {}}})[0].r, static_cast<float>(whole * 4 / 5));
  EXPECT_FLOAT_EQ(floor.shade({{both, {}}})[0].r, static_cast<float>(whole));
  EXPECT_EQ(floor.shade({{beyond, {}}})[0].r, 0) << "bits beyond the last sample are no samples";
}

TEST(Beauty, VMultipliesTheUnshadowedIntegral) {
  Floor floor({{1, 0, 0}});
  floor.lights = {rectangle(2, 2, 1, 3, 11)};
  const std::vector<std::uint32_t> all{0xffffffffu, 1};
  const std::vector<float> quarter{0.25f};
  const float unshadowed = floor.shade({{all, {}}})[0].r;
  EXPECT_GT(unshadowed, 0);
  EXPECT_FLOAT_EQ(floor.shade({{{}, quarter}})[0].r, unshadowed / 4);
}

TEST(Beauty, OnlyTheEmittingSideShines) {
  Floor floor({{0, 0, 0}});
  const std::vector<std::uint32_t> seen{1};
  floor.lights = {rectangle(2, 1, 1, 1, 1, false)};
  EXPECT_EQ(floor.shade({{seen, {}}})[0].r, 0);
  floor.lights[0].two_sided = true;
  EXPECT_FLOAT_EQ(floor.shade({{seen, {}}})[0].r, static_cast<float>(0.5 * 10 * kStraightAbove));
  floor.lights = {rectangle(-2, 1, 1, 1, 1, false)};  // below the floor, emitting up
  EXPECT_EQ(floor.shade({{seen, {}}})[0].r, 0);
}

TEST(Beauty, ALightPointOnTheSurfaceAddsNothing) {
  Floor floor({{0, 0, 0}});
  floor.lights = {rectangle(0, 1, 1, 1, 1)};
  const std::vector<std::uint32_t> seen{1};
  EXPECT_EQ(floor.shade({{seen, {}}})[0], glm::vec3(0));
}

TEST(Beauty, ASphereShinesOverItsSolidAngle) {
  Floor floor({{0, 0, 0}, {30, 0, 0}, {0, 39.5, 0}});
  Light light;
  light.kind = LightKind::sphere;
  light.center = {0, 40, 0};
  light.radius = 1;
  light.area = kPi;
  light.radiance = {10, 20, 30};
  light.coordinates = {{0.5, 0}, {-0.5, 0}, {0, 0.5}, {0, -0.5}};
  floor.lights = {light};
  const std::vector<std::uint32_t> seen{15, 15, 15};
  const auto colors = floor.shade({{seen, {}}});
  // A sphere entirely above the horizon: colour · radiance · cos θp · (r / d)², as for a point light of the same
  // intensity.
  EXPECT_FLOAT_EQ(colors[0].r, static_cast<float>(0.5 * 10 / 1600));
  EXPECT_FLOAT_EQ(colors[1].r, static_cast<float>(0.5 * 10 * 0.8 / 2500));
  EXPECT_EQ(colors[2].r, 0) << "a point inside the sphere gets no light";
}

/// A sun of radiance L gives a surface that faces it π sin²(angle / 2) L; a surface turned by 60° gets half of that.
TEST(Beauty, ASunShinesOverItsSolidAngle) {
  Floor floor({{0, 0, 0}, {1000, -7, 30}});
  scenes::Scene scene;
  scene.lights.emplace_back();
  scene.lights[0].radiance = {10, 20, 30};
  const std::vector<std::uint32_t> seen{15, 15};
  for (const double angle : {0.01, 0.53, 30.0}) {
    for (const glm::dvec3 direction : {glm::dvec3(0, -1, 0), glm::dvec3(std::sqrt(0.75), -0.5, 0)}) {
      scene.lights[0].shape = scenes::Sun{direction, angle};
      floor.lights = {visibility::make_light(scene, 0, glm::dvec3(0), {4, 2, 2, visibility::SamplePattern::grid, 0})};
      const double sine = std::sin(angle * kPi / 360), expected = 0.5 * 10 * sine * sine * -direction.y;
      for (const glm::vec3& color : floor.shade({{seen, {}}})) EXPECT_NEAR(color.r / expected, 1, 1e-6) << angle;
    }
  }
  // For a sun of angle 0, `radiance` is the irradiance of a surface that faces it; a diffuse surface shows colour / π
  // times that.
  scene.lights[0].shape = scenes::Sun{{std::sqrt(0.75), -0.5, 0}, 0};
  floor.lights = {visibility::make_light(scene, 0, glm::dvec3(0), {4, 2, 2, visibility::SamplePattern::grid, 0})};
  for (const glm::vec3& color : floor.shade({{seen, {}}})) EXPECT_NEAR(color.r, 0.5 * 10 / kPi / 2, 1e-6);
}

/// The extension's reference formula: 1 inside the inner angle, 0 outside the outer angle, between them the square of a
/// ramp in the cosine.
TEST(Beauty, ASpotLampFallsOffBetweenItsCones) {
  constexpr double kHeight = 40;
  const auto at = [&](double degrees) { return glm::vec3(kHeight * std::tan(degrees * kPi / 180), 0, 0); };
  Floor floor({at(0), at(9.9), at(20), at(29.9), at(30.1), at(60)});
  scenes::Scene scene;
  scene.lights.emplace_back();
  const std::vector<std::uint32_t> seen(6, 15);
  const auto shade = [&](std::optional<scenes::Cone> cone) {
    scene.lights[0].shape = scenes::Sphere{{0, kHeight, 0}, 1, cone};
    floor.lights = {visibility::make_light(scene, 0, glm::dvec3(0), {4, 2, 2, visibility::SamplePattern::grid, 0})};
    return floor.shade({{seen, {}}});
  };
  const auto bare = shade({}), spot = shade(scenes::Cone{{0, -1, 0}, 10, 30});
  EXPECT_EQ(spot[0], bare[0]);
  EXPECT_EQ(spot[1], bare[1]);
  const auto cosine = [](double degrees) { return std::cos(degrees * kPi / 180); };
  EXPECT_NEAR(spot[2].r / bare[2].r, std::pow((cosine(20) - cosine(30)) / (cosine(10) - cosine(30)), 2), 1e-6);
  EXPECT_GT(spot[3].r, 0);
  EXPECT_LT(spot[3].r, 0.001 * bare[3].r);
  EXPECT_EQ(spot[4].r, 0);
  EXPECT_EQ(spot[5].r, 0);
}

TEST(Beauty, WhatALightDoesNotLightIsBlack) {
  Floor floor({{0, 0, 0}, {0, 0, 0}});
  floor.scene.object[1] = 1;
  floor.colors.push_back(floor.colors[0]);
  floor.lights = {rectangle(2, 1, 1, 1, 1)};
  floor.lights[0].unlit = {0, 1};
  const std::vector<std::uint32_t> seen{1, 1};
  const auto colors = floor.shade({{seen, {}}});
  EXPECT_GT(colors[0].r, 0);
  EXPECT_EQ(colors[1], glm::vec3(0));
}

TEST(Beauty, FormFactorsAreTakenAsTheyAre) {
  Floor floor({{0, 0, 0}, {1, 0, 0}});
  floor.lights = {rectangle(2, 1, 1, 2, 2)};
  floor.scene.receives_shadow[1] = 0;
  const std::vector<glm::dvec3> seen{{0.125, 0.25, 0.5}, {0, 0, 0}};
  const std::vector<std::uint32_t> all{15, 15};
  const auto colors = floor.shade({{.form_factors = seen}});
  EXPECT_EQ(colors[0], glm::vec3(0.5 * 10 * 0.125, 0.25 * 20 * 0.25, 30 * 0.5));
  EXPECT_EQ(colors[1], floor.shade({{.masks = all}})[1]);
}

TEST(Beauty, LightsAddUp) {
  Floor floor({{0.5f, 0, 0}});
  const std::vector<std::uint32_t> one{1}, four{15};
  const std::vector<float> half{0.5f};
  floor.lights = {rectangle(2, 1, 1, 1, 1)};
  const float a = floor.shade({{one, {}}})[0].r;
  floor.lights = {rectangle(3, 1, 2, 2, 2)};
  const float b = floor.shade({{{}, half}})[0].r;
  floor.lights = {rectangle(2, 1, 1, 1, 1), rectangle(3, 1, 2, 2, 2)};
  EXPECT_FLOAT_EQ(floor.shade({{one, {}}, {{}, half}})[0].r, a + b);
}

TEST(Beauty, BackgroundEmittersAndReceiversOfNoShadow) {
  Floor floor({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  floor.lights = {rectangle(2, 1, 1, 1, 1)};
  floor.lights[0].index = 5;
  floor.samples.triangle[0] = ViewSamples::kBackground;
  floor.scene.emits[1] = 5;
  floor.scene.emits[2] = 4;  // the body of a light that is not on
  floor.scene.receives_shadow[3] = 0;
  const std::vector<std::uint32_t> hidden(4, 0);
  const auto colors = floor.shade({{hidden, {}}});
  EXPECT_EQ(colors[0], glm::vec3(0));
  EXPECT_EQ(colors[1], glm::vec3(10, 20, 30));
  EXPECT_EQ(colors[2], glm::vec3(0));
  EXPECT_FLOAT_EQ(colors[3].r, static_cast<float>(0.5 * 10 * kStraightAbove));
}

TEST(Beauty, BodiesShowTheirOwnLightOnceAndReflectThatOfOthers) {
  Floor floor({{0, 0, 0}, {0, 0, 0}});
  floor.lights = {rectangle(2, 1, 1, 1, 1), rectangle(2, 1, 1, 1, 1), rectangle(2, 1, 1, 1, 1)};
  floor.lights[0].index = floor.lights[1].index = 5;  // two pieces of one light
  floor.lights[1].piece = 1;
  floor.lights[2].index = 6;
  floor.scene.emits[0] = 5;
  const std::vector<float> full{1, 1};
  const auto colors = floor.shade({{{}, full}, {{}, full}, {{}, full}});
  const double reflected = 0.5 * 10 * kStraightAbove;
  EXPECT_FLOAT_EQ(colors[0].r, static_cast<float>(10 + reflected));
  EXPECT_FLOAT_EQ(colors[1].r, static_cast<float>(3 * reflected));
}

/// Many points, with a random mask for each.
struct ManyPoints {
  Floor floor;
  std::vector<std::uint32_t> masks;

  ManyPoints() : floor(points()), masks(3 * floor.samples.size()) {
    floor.lights = {rectangle(2, 1, 1, 5, 13)};
    std::uint32_t state = 1;
    for (std::uint32_t& word : masks) word = state = state * 1664525u + 1013904223u;
  }
  static std::vector<glm::vec3> points() {
    std::vector<glm::vec3> all;
    for (int i = 0; i < 5000; ++i)
      all.emplace_back(0.01f * static_cast<float>(i % 71), 0.0f, 0.01f * static_cast<float>(i % 97));
    return all;
  }
};

TEST(Beauty, OfABandIsAddedWhereItIsWanted) {
  const ManyPoints all;
  const Floor& floor = all.floor;
  const auto expected = floor.shade({{all.masks, {}}});
  constexpr std::size_t kFirst = 1000, kCount = 700;
  constexpr float kBefore = 0.25f;
  std::vector<glm::vec3> band(kCount, glm::vec3(kBefore));
  std::vector<float> wanted(kCount, 1.0f);
  for (std::size_t i = 0; i < kCount; i += 3) wanted[i] = std::nanf("");
  const LightVisibility seen{std::span(all.masks).subspan(3 * kFirst, 3 * kCount)};
  add_beauty({.scene = floor.scene,
              .samples = floor.samples,
              .colors = floor.colors,
              .lights = floor.lights,
              .first_pixel = kFirst},
             {&seen, 1}, wanted, band);
  for (std::size_t i = 0; i < kCount; ++i) {
    const glm::vec3 added = std::isnan(wanted[i]) ? glm::vec3(0) : expected[kFirst + i];
    ASSERT_EQ(band[i], glm::vec3(kBefore) + added) << i;
  }
}

TEST(Beauty, DoesNotDependOnTheNumberOfThreads) {
  const ManyPoints all;
  const Floor& floor = all.floor;
  const std::vector<std::uint32_t>& masks = all.masks;
  const auto many = floor.shade({{masks, {}}});
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto one = floor.shade({{masks, {}}});
  EXPECT_EQ(std::memcmp(many.data(), one.data(), many.size() * sizeof many[0]), 0);
}

}  // namespace
}  // namespace penumbra::compare
