// SPDX-License-Identifier: Apache-2.0
// The direction of each texel of a dome's picture, its light samples, and the faces that share them.

#include "tests/unit/dome_stage.hpp"
#include "visibility/dome_faces.hpp"
#include "visibility/dome_picture.hpp"
#include "visibility/masks/visible_share.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace penumbra::visibility {
namespace {

using std::numbers::pi;

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << ", " << a.y << ", " << a.z;
}

glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return glm::normalize(glm::dvec3(x, y, z));
}

Light dome_of(const scenes::AreaLight& source, std::uint32_t count, SamplePattern pattern = SamplePattern::sobol) {
  scenes::Scene scene;
  scene.lights.push_back(source);
  return make_light(scene, 0, glm::dvec3(0), {.count = count, .pattern = pattern});
}

TEST(DomeFrames, MiddleLooksAlongMinusZAndRightOfItLiesX) {
  const DomeFrame frame = dome_frame({0, 1, 0}, 0);
  expect_near(frame.direction({0, 0.5}), {0, 0, -1});
  expect_near(frame.direction({0, 0.75}), {1, 0, 0});
  expect_near(frame.direction({0, 0.25}), {-1, 0, 0});
  expect_near(frame.direction({1, 0.3}), {0, 1, 0});
  // A quarter turn about +Y, right-handed, takes −Z to −X.
  const DomeFrame turned = dome_frame({0, 1, 0}, 90);
  expect_near(turned.direction({0, 0.5}), {-1, 0, 0});
  expect_near(turned.direction({0, 0.75}), {0, 0, -1});
}

TEST(DomeFrames, AnotherUpTakesTheShortestTurn) {
  const DomeFrame z_up = dome_frame({0, 0, 2}, 0);
  expect_near(z_up.up, {0, 0, 1});
  expect_near(z_up.direction({0, 0.5}), {0, 1, 0});
  expect_near(z_up.direction({0, 0.75}), {1, 0, 0});
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 up = i == 0 ? glm::dvec3(0, -1, 0) : random_direction(random);
    const DomeFrame frame = dome_frame(up, i);
    expect_near(glm::cross(frame.right, frame.ahead), frame.up);
    EXPECT_NEAR(glm::dot(frame.right, frame.ahead), 0, 1e-12);
    EXPECT_NEAR(glm::length(frame.ahead), 1, 1e-12);
    const glm::dvec3 direction = random_direction(random);
    expect_near(frame.direction(frame.place(direction)), direction);
  }
}

/// Each of the eight octants has an equal number of samples, and each direction is of unit length.
TEST(DomeSamplesMade, OfOneRadianceAreSpreadEvenly) {
  const Light light = dome_of(tests::dome_light(), 1024);
  std::array<int, 8> octants{};
  for (const glm::vec3& d : light.points) {
    EXPECT_NEAR(glm::length(d), 1, 1e-6);
    ++octants.at((d.x > 0 ? 1U : 0U) + (d.y > 0 ? 2U : 0U) + (d.z > 0 ? 4U : 0U));
  }
  for (const int count : octants) EXPECT_NEAR(count, 128, 4);
  EXPECT_NEAR(light.dome->power, 4, 1e-12);
}

TEST(DomeSamplesMade, OfHalfADomeLieAboveItsPlane) {
  std::mt19937 random(2);
  for (int i = 0; i < 20; ++i) {
    const glm::dvec3 up = random_direction(random);
    const Light light = dome_of(tests::dome_light({.up = up, .half = true}), 256, SamplePattern::rows);
    for (const glm::vec3& d : light.points) EXPECT_GT(glm::dot(up, glm::dvec3(d)), -1e-6);
    EXPECT_NEAR(light.dome->power, 2, 1e-12);
    const std::vector<Light> faces = light_faces(light, false);
    EXPECT_EQ(faces.size(), 5U);
    for (const Light& face : faces) {
      for (const glm::dvec2& st : face.coordinates) EXPECT_GE(st.y, face.dome->half ? -1e-6 : -1);
    }
  }
}

/// A face's middle is its direction, light travels along u × v, and the faces together cover all directions once: each
/// direction is in the square of exactly one face.
TEST(DomeFacesMade, CoverAllDirectionsOnce) {
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const Light light = dome_of(tests::dome_light({.up = random_direction(random)}), 16);
    for (std::size_t k = 0; k < kDomeFaces; ++k) {
      const DomeFace face = dome_face(*light.dome, k);
      EXPECT_GT(glm::dot(-face.middle, glm::cross(face.u, face.v)), 0.99f);
    }
    for (int j = 0; j < 50; ++j) {
      const glm::vec3 d(random_direction(random));
      int holding = 0;
      for (std::size_t k = 0; k < kDomeFaces; ++k) {
        const auto [middle, u, v] = dome_face(*light.dome, k);
        const glm::dvec3 depth = glm::cross(glm::dvec3(u), glm::dvec3(v));
        if (glm::dot(glm::dvec3(d), depth) * glm::dot(glm::dvec3(middle), depth) <= 0) continue;
        const double t = glm::dot(glm::dvec3(middle), depth) / glm::dot(glm::dvec3(d), depth);
        const glm::dvec3 at = t * glm::dvec3(d) - glm::dvec3(middle);
        const bool inside = std::abs(glm::dot(at, glm::dvec3(u))) < 1 && std::abs(glm::dot(at, glm::dvec3(v))) < 1;
        holding += inside ? 1 : 0;
        if (inside) {
          EXPECT_EQ(dome_face_of(*light.dome, d), k);
        }
      }
      EXPECT_EQ(holding, 1);
    }
  }
}

/// The faces' light samples together are those of the dome, in the order of faces and at the same places.
TEST(DomeFacesMade, ShareTheLightSamples) {
  const Light light = dome_of(tests::dome_light(), 300);
  std::size_t count = 0;
  for (const Light& face : light_faces(light, false)) {
    for (std::size_t j = 0; j < face.points.size(); ++j, ++count) {
      EXPECT_EQ(face.points[j], light.points[count]);
      const glm::dvec3 toward = glm::dvec3(face.center) + face.coordinates[j].x * glm::dvec3(face.sun->axis_u) +
                                face.coordinates[j].y * glm::dvec3(face.sun->axis_v);
      EXPECT_LT(glm::distance(glm::normalize(toward), glm::normalize(glm::dvec3(face.points[j]))), 1e-7);
    }
  }
  EXPECT_EQ(count, light.sample_count());
}

/// A dome with a picture of 8 x 4: 1 everywhere except for one texel of value `bright`, (5, 1) from the top left.
scenes::AreaLight with_bright_texel(float bright, bool half) {
  scenes::AreaLight source = tests::dome_light({.half = half});
  source.texture = scenes::Texture{"made by hand", 8, 4, std::vector<glm::vec3>(32, glm::vec3(1))};
  source.texture->texels[8 + 5] = glm::vec3(bright);
  return source;
}

/// Each texel has light samples in proportion to its power: ∫ luminance dω of a texel is 2π / 8 times the difference of
/// the cosines of its borders.
TEST(DomePictures, HaveSamplesInProportionToTheirLight) {
  for (const bool half : {false, true}) {
    constexpr float kBright = 100;
    const Light light = dome_of(with_bright_texel(kBright, half), 1024);
    const double texel = 2 * pi / 8 * (std::cos(pi / 4) - 0), all = (half ? 2 : 4) * pi + (kBright - 1) * texel;
    EXPECT_NEAR(light.dome->power, all / pi, 1e-9);
    int inside = 0;
    for (std::size_t j = 0; j < light.points.size(); ++j) {
      const glm::dvec3 d(light.points[j]);
      const double turn = 0.5 + std::atan2(d.x, -d.z) / (2 * pi);
      const bool in_texel = d.y > 0 && d.y < std::cos(pi / 4) && turn > 5.0 / 8 && turn < 6.0 / 8;
      inside += in_texel ? 1 : 0;
      EXPECT_NEAR(light.sample_colors[j].r, 1, 1e-6);  // colours are relative to their own luminance
    }
    EXPECT_NEAR(inside, 1024 * kBright * texel / all, 3);
  }
}

TEST(DomePictures, OfBlackTexelsAreRefused) {
  scenes::AreaLight source = with_bright_texel(1, true);
  for (std::size_t i = 0; i < 16; ++i) source.texture->texels[i] = glm::vec3(0);
  EXPECT_THROW(dome_of(source, 16), InputError);
}

/// V is the sum of the cosines of the visible light samples, divided by that of all samples above the plane.
TEST(DomeShares, WeighByCosines) {
  const Light light = dome_of(tests::dome_light(), 64);
  std::mt19937 random(4);
  for (int i = 0; i < 20; ++i) {
    const glm::vec3 n(random_direction(random));
    std::vector<std::uint32_t> mask{static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random())};
    double some = 0, all = 0;
    for (std::size_t j = 0; j < 64; ++j) {
      const double cosine = std::max(0.0, glm::dot(glm::dvec3(n), glm::dvec3(light.points[j])));
      all += cosine;
      some += (mask[j / 32] >> j % 32 & 1U) != 0 ? cosine : 0;
    }
    EXPECT_NEAR(visible_share(light, mask, n), some / all, 1e-6);
    const std::vector<std::uint32_t> full(2, ~0U);
    EXPECT_EQ(visible_share(light, full, n), 1);
  }
}

}  // namespace
}  // namespace penumbra::visibility
