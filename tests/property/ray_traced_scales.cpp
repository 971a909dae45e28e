// SPDX-License-Identifier: Apache-2.0
// Scaling a scene by a power of two is exact in floats and changes no answer: every bit of the ray caster's masks
// stays, over the whole range of float32. Scenes that do not fit Embree's float32 are refused, or decided exactly.

#include "base/error.hpp"
#include "reference/plain_rays.hpp"
#include "tests/unit/ray_traced_masks.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace penumbra::reference {
namespace {

using tests::Masks;
using tests::Stage;

constexpr int kStep = 8;  // coordinates are multiples of 2⁻⁸, which subnormal floats can hold too

glm::vec3 snapped(const glm::vec3& x) {
  return glm::vec3(glm::round(glm::dvec3(x) * std::ldexp(1.0, kStep))) * std::ldexp(1.0F, -kStep);
}

glm::vec3 scaled(const glm::vec3& x, int exponent) {
  return {std::ldexp(x.x, exponent), std::ldexp(x.y, exponent), std::ldexp(x.z, exponent)};
}

/// Random triangles over a floor under a light of each kind.
scenes::Scene soup_at_scale(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, -1.5, 0}, {3, 0.125, 0}, {0, 0.25, -3}));
  std::vector<tests::Corners> soup;
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 center = point(1);
    soup.push_back({center + point(0.5), center + point(0.5), center + point(0.5)});
  }
  tests::add_object(scene, "soup", soup);
  const glm::dvec3 center(0.5, 3, -0.25);
  scene.lights.push_back(tests::rectangle_light(center, {0.6, 0.1, 0}, {0, 0.1, 0.7}));
  if (seed % 4 == 1) scene.lights[0].shape = scenes::Disk{center, {0.1, -1, 0.2}, 0.7};
  if (seed % 4 == 2) scene.lights[0].shape = scenes::Polygon{{{-0.5, 3, -0.5}, {0.7, 3, -0.4}, {0.1, 3, 0.8}}};
  if (seed == 3) scene.lights[0].shape = scenes::Sphere{center, 0.5};
  if (seed == 4) scene.lights[0].shape = scenes::Sun{-center, 20};
  scene.cameras.push_back(tests::camera({0.3, 1.5, 5}, {0, -0.3, 0}));
  return scene;
}

/// Makes a stage on the grid, so that scaling it is exact.
Stage snapped_stage(std::uint32_t seed) {
  Stage stage(soup_at_scale(seed), 24, 24, {32, 0, 0, visibility::SamplePattern::rows, 0});
  for (glm::vec3& x : stage.floats.positions) x = snapped(x);
  for (glm::vec3& x : stage.samples.p) x = snapped(x);
  for (glm::vec3& x : stage.light.points) x = snapped(x);
  for (glm::vec3* x : {&stage.light.center, &stage.light.center_u, &stage.light.center_v}) *x = snapped(*x);
  stage.floats.lower = snapped(stage.floats.lower);
  stage.floats.upper = snapped(stage.floats.upper);
  return stage;
}

Stage scaled(Stage stage, int exponent) {
  for (glm::vec3& x : stage.floats.positions) x = scaled(x, exponent);
  for (glm::vec3& x : stage.samples.p) x = scaled(x, exponent);
  for (glm::vec3* x : {&stage.floats.lower, &stage.floats.upper}) *x = scaled(*x, exponent);
  if (stage.light.sun) return stage;  // directions have no scale
  for (glm::vec3& x : stage.light.points) x = scaled(x, exponent);
  for (glm::vec3* x : {&stage.light.center, &stage.light.center_u, &stage.light.center_v}) *x = scaled(*x, exponent);
  stage.light.radius = std::ldexp(stage.light.radius, exponent);
  return stage;
}

std::vector<float> plain_visibility(const Stage& stage) {
  PlainRays rays({});
  rays.prepare_mesh(stage.floats);
  rays.prepare_light(stage.light);
  std::vector<float> visibility(stage.samples.size());
  rays.evaluate(stage.samples, visibility);
  return visibility;
}

class Scales : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Scales, ChangeNoBit) {
  const Stage stage = snapped_stage(GetParam());
  const Masks masks = tests::trace(stage);
  std::size_t part = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    const std::uint32_t visible = masks.visible_count(i);
    part += visible > 0 && visible < 32 ? 1 : 0;
  }
  EXPECT_GT(part, stage.samples.size() / 20) << "too few pixels are in penumbrae for this test to mean much";
  const std::vector<float> plain = plain_visibility(stage);
  // A sphere's points are rounded for each view sample, which would change them among the subnormal floats.
  const int lowest = stage.light.kind == visibility::LightKind::sphere ? -100 : -149 + kStep;
  for (int exponent = lowest; exponent <= 120; exponent += 9) {
    const Stage other = scaled(stage, exponent);
    EXPECT_EQ(tests::differing_bits(tests::trace(other), masks), 0U) << "2^" << exponent;
    EXPECT_EQ(plain_visibility(other), plain) << "2^" << exponent;
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, Scales, testing::Range(0U, 5U));

TEST(ScaleLimits, ALightTooFarForTheSceneIsRefused) {
  Stage stage = snapped_stage(0);
  for (const float direction : {0x1p30F, 0x1p45F}) {
    Stage far = stage;
    for (glm::vec3& x : far.light.points) x.y += direction;
    far.light.center.y = far.light.center_u.y = far.light.center_v.y = direction;
    EXPECT_NO_THROW(tests::trace(far)) << direction;
  }
  for (glm::vec3& x : stage.light.points) x.y += 0x1p55F;
  EXPECT_THROW(tests::trace(stage), InputError);
  EXPECT_THROW(plain_visibility(stage), InputError);
}

TEST(ScaleLimits, TrianglesTooSmallForTheSceneAreRefused) {
  scenes::Scene scene = soup_at_scale(0);
  for (const double size : {0x1p-60, 0x1p-80}) {
    scenes::Scene with_dust = scene;
    tests::add_object(with_dust, "anchor",
                      {{glm::dvec3(-4), glm::dvec3(4, 4, -4), glm::dvec3(4)}});  // keeps the origin at 0
    tests::add_object(with_dust, "dust", {{glm::dvec3(0), glm::dvec3(size, 0, 0), glm::dvec3(0, size, 0)}});
    const Stage stage(with_dust, 8, 8);
    if (size > 0x1p-70) {
      EXPECT_NO_THROW(tests::trace(stage));
    } else {
      EXPECT_THROW(tests::trace(stage), InputError);
      EXPECT_THROW(plain_visibility(stage), InputError);
    }
  }
}

/// Rays that Embree would lose are decided exactly: here the light is extremely close to a view sample, in a scene of
/// small triangles.
TEST(ScaleLimits, RaysTooShortAreDecidedExactly) {
  constexpr float kSize = 0x1p-58F;
  scenes::Scene scene;
  tests::add_object(scene, "anchor", {{glm::dvec3(-4), glm::dvec3(4, 4, -4), glm::dvec3(4)}}).casts_shadow = false;
  const double s = kSize;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4 * s, 0, 0}, {0, 0, -4 * s}));
  tests::add_object(scene, "board", tests::quad({0, s, 0}, {s, 0, 0}, {0, 0, -s}));
  scene.lights.push_back(tests::ceiling_light(2 * s, s));
  const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  const visibility::Light light = visibility::make_light(scene, 0, floats.origin, {64});
  visibility::ViewSamples samples;
  samples.width = 9;
  samples.height = 9;
  for (int z = -4; z <= 4; ++z) {
    for (int x = -4; x <= 4; ++x) {
      samples.triangle.push_back(x > -z ? 2 : 1);
      samples.p.emplace_back(static_cast<float>(x) * kSize * 0.9F, 0.0F, static_cast<float>(z) * kSize * 0.9F);
      samples.n.emplace_back(0, 1, 0);
      samples.depth.push_back(1);
      const auto [a, b, c] = floats.corners(static_cast<std::uint32_t>(samples.triangle.back()));
      const glm::dvec3 n = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
      samples.facing.push_back(n.y > 0 ? 1 : -1);
    }
  }
  const auto method = make_ray_traced({});
  const Masks masks = tests::trace(floats, light, samples);
  std::size_t visible = 0, hidden = 0;
  for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
    for (std::uint32_t j = 0; j < light.sample_count(); ++j) {
      const auto truth = visibility::decide_pair(floats, samples, pixel, light, j);
      const bool sees = truth.outcome == visibility::PairOutcome::visible;
      ++(sees ? visible : hidden);
      EXPECT_EQ(masks.visible(pixel, j), sees) << pixel << " " << j;
    }
  }
  EXPECT_GT(visible, 100U);
  EXPECT_GT(hidden, 100U);
}

}  // namespace
}  // namespace penumbra::reference
