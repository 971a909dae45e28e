// SPDX-License-Identifier: Apache-2.0
// Tests `exact` with textures: against the areas of many small lights, one for each texel, and against closed forms.
// The tolerance is that of exact_area_closed_forms.cpp; integrals of a piecewise constant texture are lengths of the
// same edges times sums of at most 2048 luminances in double, whose rounding is far below it.

#include "tests/unit/exact_area_scenes.hpp"
#include "tests/unit/textured_lights_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace penumbra::areas {
namespace {

using tests::area_scene;
using tests::AreaStage;
using tests::random_dyadic;
using tests::texture_of;

constexpr double kRounding = 1e-12;

/// Lights of the tests: one overhead, and one that stands upright and is cut by the floor's horizon at a third of its
/// height.
scenes::AreaLight overhead() {
  return tests::ceiling_light(4, 1);
}
scenes::AreaLight rising() {
  return tests::rectangle_light({0, 0.5, -4}, {1.5, 0, 0}, {0.25, 1.5, 0});
}

std::vector<tests::Corners> random_triangles(std::mt19937& random, int count) {
  const auto point = [&] {
    return glm::dvec3(random_dyadic(random, -2, 2), random_dyadic(random, -0.5, 3.5), random_dyadic(random, -3.5, 2));
  };
  std::vector<tests::Corners> triangles;
  for (int i = 0; i < count; ++i) triangles.push_back({point(), point(), point()});
  return triangles;
}

/// The part of a rectangle light that one texel of width × height covers; exact in floats for powers of two.
scenes::AreaLight cell_of(const scenes::AreaLight& light, std::uint32_t x, std::uint32_t y, std::uint32_t width,
                          std::uint32_t height) {
  const auto& whole = std::get<scenes::Rectangle>(light.shape);
  const double s = (2.0 * x + 1) / width - 1, t = 1 - (2.0 * y + 1) / height;
  return tests::rectangle_light(whole.center + s * whole.half_u + t * whole.half_v,
                                whole.half_u / static_cast<double>(width), whole.half_v / static_cast<double>(height));
}

scenes::Scene with_light(scenes::Scene scene, scenes::AreaLight light, std::optional<scenes::Texture> texture = {}) {
  light.texture = std::move(texture);
  scene.lights.push_back(std::move(light));
  return scene;
}

TEST(TexturedLightExact, IsTheMeanOfItsTexelsLights) {
  constexpr unsigned kSeed = 3;
  std::mt19937 random(kSeed);
  int part = 0;
  for (int round = 0; round < 6; ++round) {
    const std::uint32_t width = 1u << random() % 4, height = 1u << random() % 4;
    const scenes::Texture texture = texture_of(width, height, [&](std::uint32_t x, std::uint32_t y) {
      return glm::vec3(x + y == 0 ? 1.0f : static_cast<float>(random() % 5) / 4.0f);  // some are black
    });
    const scenes::AreaLight light = round % 2 == 0 ? overhead() : rising();
    const scenes::Scene soup = area_scene(random_triangles(random, 12));
    const AreaStage textured(with_light(soup, light, texture), 256);
    std::vector<std::unique_ptr<AreaStage>> cells;
    for (std::uint32_t i = 0; i < width * height; ++i) {
      cells.push_back(
          std::make_unique<AreaStage>(with_light(soup, cell_of(light, i % width, i / width, width, height))));
    }
    for (int i = 0; i < 12; ++i) {
      const glm::vec3 p(random_dyadic(random, -3, 3), 0, random_dyadic(random, -3, 3));
      double sum = 0, all = 0;
      for (std::size_t k = 0; k < cells.size(); ++k) {
        const double luminance = textured.light.texture->luminance[k];
        if (luminance > 0) sum += luminance * cells[k]->visibility(p);
        all += luminance;
      }
      const double v = textured.visibility(p);
      ASSERT_NEAR(v, sum / all, kRounding) << width << "x" << height << ", seed " << kSeed << ", round " << round;
      if (i == 0) {
        ASSERT_NEAR(textured.visibility(p, SweepArithmetic::rational), v, kRounding);
      }
      part += v > 0 && v < 1 ? 1 : 0;
    }
  }
  EXPECT_GT(part, 40);
}

TEST(TexturedLightExact, AConstantTextureIsNone) {
  constexpr unsigned kSeed = 4;
  std::mt19937 random(kSeed);
  for (const scenes::AreaLight& light : {overhead(), rising()}) {
    const scenes::Scene soup = area_scene(random_triangles(random, 20));
    const AreaStage plain(with_light(soup, light));
    const AreaStage textured(with_light(soup, light, tests::constant_texture(37, 19, glm::vec3(0.3f, 0.1f, 0.7f))));
    for (int i = 0; i < 20; ++i) {
      const glm::vec3 p(random_dyadic(random, -3, 3), 0, random_dyadic(random, -3, 3));
      ASSERT_NEAR(textured.visibility(p), plain.visibility(p), kRounding) << "seed " << kSeed << ", " << i;
    }
  }
}

TEST(TexturedLightExact, AnEdgeAcrossAGradientLeavesItsIntegral) {
  // A wall whose upper edge, parallel to the light's rows, hides everything below t = e on the light. The luminance of
  // the texture's rows grows by one from the bottom: 1, 2 … n. V is the rest of the integral of this staircase.
  constexpr std::uint32_t kRows = 7;
  const auto staircase =
      texture_of(3, kRows, [](std::uint32_t, std::uint32_t y) { return glm::vec3(static_cast<float>(kRows - y)); });
  // The light stands upright at z = −4, t = (y − 2) / 1; the wall, at z = −2, is half way from p at z = 0: it hides y <
  // 2 (h − p.y) + p.y.
  for (const double h : {0.5, 0.75, 1.0, 1.234375, 1.5}) {
    scenes::Scene scene = area_scene(tests::quad({0, h - 2, -2}, {8, 0, 0}, {0, 2, 0}));
    scene.lights.push_back(tests::rectangle_light({0, 2, -4}, {1, 0, 0}, {0, 1, 0}));
    scene.lights.back().texture = staircase;
    const double rows_hidden = std::clamp((2 * h - 1) / 2, 0.0, 1.0) * kRows;
    double hidden = 0;
    for (std::uint32_t row = 0; row < kRows; ++row) hidden += (row + 1) * std::clamp(rows_hidden - row, 0.0, 1.0);
    const AreaStage stage(scene);
    EXPECT_NEAR(stage.visibility({0.25f, 0, 0}), 1 - hidden / (kRows * (kRows + 1) / 2.0), kRounding) << h;
  }
}

}  // namespace
}  // namespace penumbra::areas
