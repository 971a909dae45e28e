// SPDX-License-Identifier: Apache-2.0
// Tests areas of domes with a picture: against closed forms, against the dome of one radiance, against a million
// directions, and the integrals of a sky against one another.

#include "tests/unit/dome_stage.hpp"
#include "tests/unit/visibility/soups.hpp"
#include "visibility/dome_faces.hpp"
#include "visibility/dome_picture.hpp"
#include "visibility/skies/sky.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace penumbra::tests {
namespace {

using std::numbers::pi;
using visibility::DomeFrame;
using visibility::luminance_of;
using visibility::Sky;
using visibility::SkyFlux;

scenes::Texture picture(std::uint32_t width, std::uint32_t height,
                        const std::function<glm::vec3(std::uint32_t, std::uint32_t)>& texel) {
  scenes::Texture made{"made by hand", width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) made.texels.push_back(texel(x, y));
  }
  return made;
}

scenes::Texture random_picture(std::mt19937& random, std::uint32_t width, std::uint32_t height) {
  std::uniform_real_distribution<float> unit(0, 1);
  return picture(width, height, [&](std::uint32_t, std::uint32_t) {
    const float r = unit(random), g = unit(random), bright = unit(random);
    return glm::vec3(r, g * g, bright < 0.1F ? 20.0F : 0.0F);
  });
}

/// A floor at y = 0, seen from above, under a dome with a picture.
scenes::Scene floor_scene(const scenes::Dome& dome, scenes::Texture sky) {
  scenes::Scene scene;
  add_object(scene, "floor", quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}));
  scene.cameras.push_back(camera({0.3, 6, 4}, {0.1, 0, 0.2}, 12));
  scene.lights.push_back(dome_light(dome));
  scene.lights.front().texture = std::move(sky);
  return scene;
}

/// Checks V of the area methods at floor pixels.
void expect_shares(const scenes::Scene& scene, const std::function<double(const glm::dvec3&)>& expected, double off) {
  const Stage stage(scene, 16, 16, {});
  for (const auto& [name, method] : dome_area_methods()) {
    const DomeAnswer answer = answer_of(*method, stage);
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      const std::int32_t triangle = stage.samples.triangle[i];
      if (triangle < 0 || stage.floats.object[static_cast<std::size_t>(triangle)] != 0) continue;
      ++pixels;
      const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
      ASSERT_NEAR(answer.masks.visibility[i], expected(p), off) << name << " at " << p.x << ", " << p.z;
    }
    EXPECT_GT(pixels, 50U) << name;
  }
}

/// The form factor of a rectangle that stands on the element's plane at distance `c`: from its foot it extends `a` to
/// one side and `b` up (J. Howell, C-12).
double wall_factor(double a, double b, double c) {
  const double far = std::hypot(b, c);
  return (std::atan(a / c) - c / far * std::atan(a / far)) / (2 * pi);
}

/// A wall across the border between the two texels of a picture: on each half of the sky it hides the form factor of
/// its own rectangle.
TEST(SkyExact, AStepIsHiddenByItsHalvesOfAWall) {
  constexpr double kLeft = 1, kRight = 5, kHeight = 1.5, kAt = -1.25, kLong = 3;
  for (const bool half : {false, true}) {
    scenes::Scene scene = floor_scene({.half = half}, picture(2, 1, [](std::uint32_t x, std::uint32_t) {
                                        return glm::vec3(x == 0 ? float{kLeft} : float{kRight});
                                      }));
    add_object(scene, "wall", quad({0, kHeight / 2, kAt}, {kLong, 0, 0}, {0, kHeight / 2, 0}));
    expect_shares(
        scene,
        [&](const glm::dvec3& p) {
          const double far = p.z - kAt;
          const double left = wall_factor(kLong + p.x, kHeight, far), right = wall_factor(kLong - p.x, kHeight, far);
          return 1 - (kLeft * left + kRight * right) / ((kLeft + kRight) / 2);
        },
        1e-6);
  }
}

/// A high wall that begins at its edge's azimuth hides that part of a texel; V is the rest of the texel's range of
/// azimuths.
TEST(SkyExact, ATexelIsHiddenByItsAzimuths) {
  constexpr double kFirst = 0.25 * pi, kLast = 0.5 * pi;  // right of −Z: texel 5 of 8
  const double edge = 1.5, far = 2;                       // the wall is at z = −far, x ≥ edge
  scenes::Scene scene = floor_scene(
      {}, picture(8, 4, [](std::uint32_t x, std::uint32_t y) { return glm::vec3(x == 5 && y == 1 ? 3.0F : 0.0F); }));
  constexpr double kLong = 1 << 20;
  add_object(scene, "wall", quad({edge + kLong, kLong, -far}, {kLong, 0, 0}, {0, kLong, 0}));
  expect_shares(
      scene,
      [&](const glm::dvec3& p) {
        const double azimuth = std::atan2(edge - p.x, far + p.z);
        return (std::clamp(azimuth, kFirst, kLast) - kFirst) / (kLast - kFirst);
      },
      2e-5);  // the wall ends 2^-20 before the azimuth of +X, and just below the zenith
}

/// A sky whose light comes only from below the floor gives V = 0 there, as with light samples.
TEST(SkyExact, WhatIsBlackAboveTheFloorGivesNothing) {
  expect_shares(
      floor_scene({}, picture(8, 4, [](std::uint32_t, std::uint32_t y) { return glm::vec3(y < 2 ? 0 : 1); })),
      [](const glm::dvec3&) { return 0.0; }, 0);
}

scenes::Dome pictured_dome(std::uint32_t seed) {
  switch (seed % 4) {
    case 0:
      return {};
    case 1:
      return {.half = true};
    case 2:
      return {.up = glm::normalize(glm::dvec3(0.2, 1, -0.3)), .rotate = 40};
    default:
      return {.up = glm::normalize(glm::dvec3(0.4, 1, 0.1)), .rotate = -70, .half = true};
  }
}

scenes::Scene soup_under_sky(std::uint32_t seed, std::optional<scenes::Texture> sky) {
  std::mt19937 random(seed);
  scenes::Scene scene = soup_over_tilted_floor(random, 40);
  scene.lights.push_back(dome_light(pictured_dome(seed)));
  scene.lights.front().texture = std::move(sky);
  return scene;
}

class SkyAreas : public testing::TestWithParam<std::uint32_t> {};

TEST_P(SkyAreas, OfOneColourAreThoseOfOneRadiance) {
  const auto white = picture(16, 9, [](std::uint32_t, std::uint32_t) { return glm::vec3(1); });
  const Stage stage(soup_under_sky(GetParam(), {}), 12, 12, {});
  const Stage sky(soup_under_sky(GetParam(), white), 12, 12, {});
  const auto methods = dome_area_methods(), again = dome_area_methods();
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const DomeAnswer a = answer_of(*methods[m].second, stage), b = answer_of(*again[m].second, sky);
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      ASSERT_NEAR(a.masks.visibility[i], b.masks.visibility[i], 6e-8) << methods[m].first << " " << i;
      for (int color = 0; color < 3; ++color)
        ASSERT_NEAR(a.form_factors[i].x, b.form_factors[i][color], 1e-11) << methods[m].first << " " << i;
    }
  }
}

/// Returns whether a ray meets a triangle, in double.
bool meets(const glm::dvec3& p, const glm::dvec3& d, const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a = glm::dvec3(corners[0]) - p, b = glm::dvec3(corners[1]) - p, c = glm::dvec3(corners[2]) - p;
  const double x = glm::dot(d, glm::cross(a, b)), y = glm::dot(d, glm::cross(b, c)), z = glm::dot(d, glm::cross(c, a));
  if (!((x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0))) return false;
  const glm::dvec3 n = glm::cross(b - a, c - a);
  return glm::dot(n, a) * glm::dot(n, d) > 0;
}

/// Sums over a million directions, one in each cell of a grid that divides the texels evenly. The error of a cell in
/// which visibility changes is at most its weight, and these errors are independent: four times the root of the sum of
/// their squares is never reached in practice.
TEST_P(SkyAreas, AreThoseOfAMillionDirections) {
  constexpr std::uint32_t kColumns = 9, kRows = 5, kAcross = 1008, kDown = 1000;
  std::mt19937 random(GetParam() + 100);
  const scenes::Texture sky = random_picture(random, kColumns, kRows);
  const Stage stage(soup_under_sky(GetParam(), sky), 12, 12, {});
  const auto methods = dome_area_methods();
  const DomeAnswer rows = answer_of(*methods[0].second, stage), exact = answer_of(*methods[1].second, stage);
  const scenes::Dome dome = pictured_dome(GetParam());
  const DomeFrame frame = visibility::dome_frame(dome.up, dome.rotate);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t judged = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0) continue;
    ASSERT_NEAR(rows.masks.visibility[i], exact.masks.visibility[i], 2e-6) << i;
    for (int color = 0; color < 3; ++color)
      ASSERT_NEAR(rows.form_factors[i][color], exact.form_factors[i][color], 1e-6) << i;
    const float v = rows.masks.visibility[i];
    if (v == 0 || v == 1 || judged == 1) continue;
    ++judged;
    const glm::dvec3 p(stage.samples.p[i]), n = glm::normalize(glm::dvec3(stage.samples.n[i]));
    const auto carrier = static_cast<std::uint32_t>(stage.samples.triangle[i]);
    double seen = 0, whole = 0, squares = 0;
    glm::dvec3 form_factor(0);
    std::vector<std::uint8_t> above(kAcross, 2);
    for (std::uint32_t y = 0; y < kDown; ++y) {
      const double upper = std::cos(pi * y / kDown), lower = std::cos(pi * (y + 1) / kDown);
      std::uint8_t before = 2;
      for (std::uint32_t x = 0; x < kAcross; ++x) {
        const glm::dvec3 d = frame.direction({upper + unit(random) * (lower - upper), (x + unit(random)) / kAcross});
        const glm::dvec3 color(sky.texels[y / (kDown / kRows) * kColumns + x / (kAcross / kColumns)]);
        const double cosine = glm::dot(n, d);
        if (cosine <= 0 || (dome.half && glm::dot(d, frame.up) < 0)) continue;
        const double weight = 2 / double{kAcross} * (upper - lower) * cosine;
        whole += weight * luminance_of(color);
        bool visible = true;
        for (std::uint32_t k = 0; k < stage.floats.triangles.size() && visible; ++k)
          visible = stage.floats.plane[k] == stage.floats.plane[carrier] || !meets(p, d, stage.floats.corners(k));
        if (before != static_cast<std::uint8_t>(visible) || above[x] != static_cast<std::uint8_t>(visible))
          squares += weight * weight * luminance_of(color) * luminance_of(color);
        before = above[x] = static_cast<std::uint8_t>(visible);
        if (!visible) continue;
        seen += weight * luminance_of(color);
        form_factor += weight * color;
      }
    }
    const double off = 4 * std::sqrt(squares) + 1e-5 * whole;  // the last term: the cosine changes within a cell
    EXPECT_LT(off, 0.01 * whole);
    EXPECT_NEAR(v, seen / whole, off / whole) << i;
    EXPECT_NEAR(luminance_of(rows.form_factors[i]), luminance_of(form_factor), off) << i;
  }
  EXPECT_EQ(judged, 1U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SkyAreas, testing::Range(0U, 4U));
INSTANTIATE_TEST_SUITE_P(SeedsFull, SkyAreas, testing::Range(4U, 40U));

glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return glm::normalize(glm::dvec3(x, y, z));
}

double largest_difference(const SkyFlux& a, const SkyFlux& b) {
  double largest = 0;
  for (int color = 0; color < 3; ++color) largest = std::max(largest, glm::length(a[color] - b[color]));
  return largest;
}

/// The sky's parts above and below a plane add up to the faces, and a plane cuts each face in two. Sides on a face's
/// border, which come from tables, equal sides just inside, which are summed from texel to texel.
TEST(SkySums, FacesHalvesAndBordersAgree) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (std::uint32_t i = 0; i < 60; ++i) {
    scenes::Scene scene = floor_scene({.up = random_direction(random), .half = i % 2 == 1},
                                      random_picture(random, 1 + i % 37, 1 + i * 7 % 24));
    const visibility::Light light = visibility::make_light(scene, 0, glm::dvec3(0), {});
    const Sky& sky = *light.dome->sky;
    const glm::dvec3 n = i % 5 == 0 ? glm::dvec3(light.dome->axes[i / 5 % 3]) : random_direction(random);
    SkyFlux all(0.0), above(0.0);
    for (const visibility::Light& face : visibility::light_faces(light, true)) {
      const auto number = static_cast<std::size_t>(face.dome->face);
      all += sky.of_face(number);
      above += sky.of_face_above(number, n);
      const SkyFlux parts = sky.of_face_above(number, n) + sky.of_face_above(number, -n);
      EXPECT_LT(largest_difference(parts, sky.of_face(number)), 1e-12) << i;
      const double from = unit(random), to = unit(random), off = 1e-13;
      const auto side = [&](const glm::dvec2& a, const glm::dvec2& b) {
        double exposure = 0;
        return sky.side(number, a, b, exposure);
      };
      for (const double border : {-1.0, 1.0}) {
        const double inside = border * (1 - off);
        EXPECT_LT(largest_difference(side({border, from}, {border, to}), side({inside, from}, {inside, to})), 1e-10);
        EXPECT_LT(largest_difference(side({from, border}, {to, border}), side({from, inside}, {to, inside})), 1e-10);
      }
    }
    EXPECT_LT(largest_difference(above, sky.above(n)), 1e-12) << i;
    EXPECT_LT(largest_difference(sky.above(n) + sky.above(-n), all), 1e-12) << i;
  }
}

}  // namespace
}  // namespace penumbra::tests
