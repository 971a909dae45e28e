// SPDX-License-Identifier: Apache-2.0
#include "import/gltf/emitters/sphere_light.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace penumbra::scenes {
namespace {

constexpr double kPi = std::numbers::pi;

struct Ball {
  std::vector<glm::dvec3> points;
  std::vector<mesh::Triangle> triangles;

  [[nodiscard]] double area() const {
    double sum = 0;
    for (const mesh::Triangle& t : triangles)
      sum += glm::length(glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]])) / 2;
    return sum;
  }
};

/// Makes Blender's UV sphere: rings of quads, a fan at each pole, in single precision around (5, -3, 2).
Ball uv_sphere(std::uint32_t segments, std::uint32_t rings, double stretch = 1) {
  Ball ball;
  for (std::uint32_t r = 0; r <= rings; ++r) {
    for (std::uint32_t s = 0; s < segments; ++s) {
      const double up = kPi * r / rings, around = 2 * kPi * s / segments;
      const glm::vec3 unit(std::sin(up) * std::cos(around), std::cos(up), -std::sin(up) * std::sin(around));
      ball.points.push_back(glm::dvec3(5, -3, 2) + 0.7 * glm::dvec3(unit) * glm::dvec3(1, stretch, 1));
      if (r == rings) continue;
      const std::uint32_t a = r * segments + s, b = r * segments + (s + 1) % segments;
      ball.triangles.push_back({a, a + segments, b});
      ball.triangles.push_back({b, a + segments, b + segments});
    }
  }
  return ball;
}

TEST(SphereLight, HasTheAreaOfItsMesh) {
  for (const std::uint32_t segments : {32u, 64u}) {
    const Ball ball = uv_sphere(segments, segments / 2);
    const auto sphere = recognise_sphere(import::weld(ball.points, ball.triangles), 1e-6);
    ASSERT_TRUE(sphere) << segments;
    EXPECT_LT(glm::distance(sphere->center, glm::dvec3(5, -3, 2)), 1e-6);
    EXPECT_NEAR(4 * kPi * sphere->radius * sphere->radius, ball.area(), 1e-12);
    EXPECT_LT(sphere->radius, 0.7);
    EXPECT_GT(sphere->radius, 0.99 * 0.7);
  }
}

/// Blender computes the corners of its spheres from sines and cosines in single precision: they are up to 2e-6 of the
/// radius off.
TEST(SphereLight, IsWhatSinglePrecisionMakesOfIt) {
  const Ball ball = uv_sphere(48, 24);
  import::Welded mesh = import::weld(ball.points, ball.triangles);
  std::size_t number = 0;
  for (glm::dvec3& p : mesh.points) p *= 1 + (++number % 2 == 0 ? 2e-6 : -2e-6);
  EXPECT_TRUE(recognise_sphere(mesh, 1.2e-7));
}

TEST(SphereLight, IsNothingElse) {
  const auto is_sphere = [](const Ball& ball) {
    return recognise_sphere(import::weld(ball.points, ball.triangles), 1e-6).has_value();
  };
  EXPECT_FALSE(is_sphere(uv_sphere(32, 16, 1.001))) << "an ellipsoid";
  EXPECT_FALSE(is_sphere(uv_sphere(4, 2))) << "an octahedron: its corners are on a sphere";
  Ball half = uv_sphere(32, 16);
  half.triangles.resize(half.triangles.size() / 2);
  EXPECT_FALSE(is_sphere(half));
  Ball inward = uv_sphere(32, 16);
  for (mesh::Triangle& t : inward.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(is_sphere(inward));
  EXPECT_FALSE(is_sphere(uv_sphere(16, 8))) << "a polyhedron, which shines up to 0.8 % brighter or darker";
  EXPECT_FALSE(is_sphere({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}})) << "flat";
}

}  // namespace
}  // namespace penumbra::scenes
