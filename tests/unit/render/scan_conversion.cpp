// SPDX-License-Identifier: Apache-2.0
// Tests that view samples found with the processor's vectors equal their definition bit for bit in cases near the
// limits of floats: corners that lie on pixels' rays up to rounding, triangles far smaller than a pixel, eyes far from
// the origin.

#include "engines/vectors/scan_conversion.hpp"

#include "tests/agreement/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace penumbra::vectors {
namespace {

using tests::Corners;
using visibility::ViewSamples;

/// Returns how many pixels see something.
std::size_t check(const scenes::Scene& scene, std::uint32_t width, std::uint32_t height) {
  const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
  std::size_t covered = 0;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    SCOPED_TRACE("camera " + std::to_string(i));
    const auto camera = visibility::make_camera(scene.cameras[i], floats.origin, width, height);
    const ViewSamples expected = visibility::brute_force_view_samples(floats, camera),
                      found = scan_view_samples(floats, camera);
    EXPECT_EQ(found.triangle, expected.triangle);
    EXPECT_EQ(found.p, expected.p);
    EXPECT_EQ(found.n, expected.n);
    EXPECT_EQ(found.depth, expected.depth);
    EXPECT_EQ(found.facing, expected.facing);
    covered += static_cast<std::size_t>(std::ranges::count_if(expected.triangle, [](auto t) { return t >= 0; }));
  }
  return covered;
}

/// Returns a sphere made of rings of triangles.
std::vector<Corners> sphere(int rings, double radius) {
  const auto at = [&](int ring, int turn) {
    const double down = std::numbers::pi * ring / rings, around = std::numbers::pi * turn / rings;
    return radius * glm::dvec3(std::sin(down) * std::cos(around), std::cos(down), std::sin(down) * std::sin(around));
  };
  std::vector<Corners> soup;
  for (int ring = 0; ring < rings; ++ring) {
    for (int turn = 0; turn < 2 * rings; ++turn) {
      soup.push_back({at(ring, turn), at(ring + 1, turn), at(ring + 1, turn + 1)});
      soup.push_back({at(ring, turn), at(ring + 1, turn + 1), at(ring, turn + 1)});
    }
  }
  return soup;
}

TEST(ScanConversion, CornersOnTheRaysOfPixelsAreNotLost) {
  constexpr std::uint32_t kWidth = 45, kHeight = 33;
  std::size_t covered = 0;
  for (std::uint32_t seed = 0; seed < 32; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
    const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random() % end); };
    scenes::Scene scene;
    const double fov = std::array{90.0, 40.0, 3.0, 150.0}[seed % 4],
                 far = std::array{0.0, 4.0, 300.0, 1e5}[seed / 4 % 4];
    const glm::dvec3 eye = glm::dvec3(far) + point(1);
    scene.cameras.push_back(tests::camera(eye, eye + point(1), fov));
    const auto rays = visibility::make_camera(scene.cameras[0], glm::dvec3(0), kWidth, kHeight);
    std::vector<Corners> soup;
    for (int i = 0; i < 3000; ++i) {
      const glm::dvec3 ray = rays.direction(below(kWidth), below(kHeight));
      const double t = 2 + real(random), pixel = 2 * t * rays.tan_half_fov / kHeight;
      const glm::dvec3 at = eye + t * ray;
      const double size = pixel * std::ldexp(1.0, -static_cast<int>(random() % 10));
      // Some are seen nearly edge-on.
      const glm::dvec3 along = i % 6 == 0 ? 4 * std::abs(real(random)) * ray : point(size);
      soup.push_back({at, at + along, at + point(size)});
    }
    soup.push_back({glm::dvec3(-far), glm::dvec3(-far, -far, 1 - far), glm::dvec3(-far, 1 - far, -far)});
    tests::add_object(scene, "specks", soup);
    covered += check(scene, kWidth, kHeight);
  }
  EXPECT_GT(covered, 32U * kWidth * kHeight / 8);
}

TEST(ScanConversion, ManyTrianglesAPixel) {
  // Cameras outside, inside, just above the surface, and so far away that the whole sphere is in one pixel.
  scenes::Scene scene;
  tests::add_object(scene, "sphere", sphere(90, 1));
  scene.cameras.push_back(tests::camera({0.3, 0.4, 3}, {0, 0, 0}, 50));
  scene.cameras.push_back(tests::camera({0.1, 0.2, 0.3}, {1, 0, 0.2}, 120));
  scene.cameras.push_back(tests::camera({0, 0.3, 0.96}, {0.9, 0.4, 0.5}, 80));
  scene.cameras.push_back(tests::camera({0, 1e4, 1e4}, {0, 0, 0}, 1));
  scene.cameras.push_back(tests::camera({0, 1.00001, 0}, {0.3, 0, 0.9}, 80));  // a pole is almost at the eye
  EXPECT_GT(check(scene, 40, 31), 3000U);
}

TEST(ScanConversion, ScenesOfAnySizeLookTheSame) {
  std::vector<std::int32_t> first;
  for (const int exponent : {0, -70, -40, 40, 90}) {
    SCOPED_TRACE(exponent);
    const double size = std::ldexp(1.0, exponent);
    scenes::Scene scene;
    tests::add_object(scene, "sphere", sphere(40, size));
    scene.cameras.push_back(tests::camera(size * glm::dvec3(0.3, 0.4, 3), {0, 0, 0}, 50));
    const visibility::SceneFloats floats = visibility::make_scene_floats(scene);
    const auto camera = visibility::make_camera(scene.cameras[0], floats.origin, 50, 40);
    const std::vector<std::int32_t> found = scan_view_samples(floats, camera).triangle;
    if (first.empty()) first = visibility::brute_force_view_samples(floats, camera).triangle;
    EXPECT_EQ(found, first);
  }
}

}  // namespace
}  // namespace penumbra::vectors
