// SPDX-License-Identifier: Apache-2.0
#include "visibility/view_samples.hpp"

#include "base/error.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/lights/horizon.hpp"
#include "visibility/pair_truth.hpp"

#include <CGAL/MP_Float.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace penumbra::visibility {
namespace {

TEST(Camera, RaysGoThroughPixelCentres) {
  const PinholeCamera camera = make_camera(tests::camera({1, 2, 10}, {1, 2, 0}, 90), {1, 2, 3}, 4, 2);
  EXPECT_EQ(camera.eye, glm::dvec3(0, 0, 7));
  EXPECT_NEAR(camera.tan_half_fov, 1, 1e-15);
  const glm::dvec3 first = camera.direction(0, 0), last = camera.direction(3, 1);
  EXPECT_NEAR(glm::length(first - glm::dvec3(-1.5, 0.5, -1)), 0, 1e-15);  // t is measured along the view axis
  EXPECT_NEAR(glm::length(last - glm::dvec3(1.5, -0.5, -1)), 0, 1e-15);
}

/// The picture's middle moves by shares of its height; objects parallel to the picture keep their shape and depth.
TEST(Camera, AShiftedLensMovesThePictureAndTurnsNothing) {
  scenes::Camera shifted = tests::camera({0, 0, 7}, {0, 0, 0}, 90);
  shifted.shift = {0.25, -0.5};
  const PinholeCamera camera = make_camera(shifted, glm::dvec3(0), 4, 2);
  EXPECT_EQ(camera.forward, glm::dvec3(0, 0, -1));
  EXPECT_NEAR(glm::length(camera.direction(0, 0) - glm::dvec3(-1.5 + 0.5, 0.5 - 1, -1)), 0, 1e-15);
  EXPECT_NEAR(glm::length(camera.direction(3, 1) - glm::dvec3(1.5 + 0.5, -0.5 - 1, -1)), 0, 1e-15);
  for (const std::uint32_t x : {0U, 3U}) {
    const glm::dvec3 ray = camera.direction(x, 1);
    EXPECT_NEAR(glm::dot(camera.screen_across(), ray), (2 * (x + 0.5) / 4 - 1), 1e-15) << "and back";
    EXPECT_NEAR(glm::dot(camera.screen_upward(), ray), -0.5, 1e-15);
  }
  shifted.height = 3;
  const PinholeCamera flat = make_camera(shifted, glm::dvec3(0), 4, 2);
  EXPECT_NEAR(glm::length(flat.ray(0, 0).start - glm::dvec3(1.5 * (-1.5 + 0.5), 1.5 * (0.5 - 1), 7)), 0, 1e-15);
  EXPECT_EQ(flat.ray(0, 0).direction, glm::dvec3(0, 0, -1));
}

TEST(Camera, RefusesWhatHasNoView) {
  EXPECT_THROW(make_camera(tests::camera({1, 2, 3}, {1, 2, 3}), glm::dvec3(0), 4, 4), InputError);
  EXPECT_THROW(make_camera(tests::camera({0, 0, 0}, {0, 5, 0}), glm::dvec3(0), 4, 4), InputError);
  EXPECT_THROW(make_camera(tests::camera({0.1, 0.3, 0.7}, {0.1, 5, 0.7}), glm::dvec3(0), 4, 4), InputError);
  EXPECT_THROW(make_camera(tests::camera({0, 0, 0}, {1, 0, 0}, 180), glm::dvec3(0), 4, 4), InputError);
}

TEST(ViewSamples, SeeTheNearestTriangleAndItsSideTowardTheViewer) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "board", tests::quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}));
  scene.cameras.push_back(tests::camera({0, 8, 0.001}, {0, 0, 0}));
  scene.lights.push_back(tests::ceiling_light(9, 1));
  const tests::Stage setup(scene, 33, 33);
  const ViewSamples& samples = setup.samples;
  const std::size_t middle = 16 * 33 + 16, corner = 0;
  EXPECT_GE(samples.triangle[middle], 2);
  EXPECT_NEAR(samples.p[middle].y + setup.floats.origin.y, 1, 1e-6);
  EXPECT_LT(samples.triangle[corner], 2);
  for (std::size_t pixel = 0; pixel < samples.size(); ++pixel) {
    ASSERT_NE(samples.triangle[pixel], ViewSamples::kBackground);
    EXPECT_EQ(samples.n[pixel], glm::vec3(0, 1, 0));
    const auto corners = setup.floats.corners(static_cast<std::uint32_t>(samples.triangle[pixel]));
    const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    EXPECT_GT(normal.y * static_cast<float>(samples.facing[pixel]), 0);
    EXPECT_TRUE(above_horizon(corners, samples.facing[pixel], {0, 5, 0}));
    EXPECT_FALSE(above_horizon(corners, samples.facing[pixel], {0, -5, 0}));
    EXPECT_FALSE(above_horizon(corners, samples.facing[pixel], corners[1])) << "on the plane is not strictly above";
  }
}

TEST(ViewSamples, BackgroundIsEmpty) {
  scenes::Scene scene;
  tests::add_object(scene, "speck", {{glm::dvec3(0, 0, 0), glm::dvec3(0.1, 0, 0), glm::dvec3(0, 0.1, 0)}});
  scene.cameras.push_back(tests::camera({0, 0, 5}, {0, 4, 0}));
  scene.lights.push_back(tests::ceiling_light(9, 1));
  const tests::Stage setup(scene, 4, 4);
  EXPECT_EQ(setup.samples.triangle, std::vector<std::int32_t>(16, ViewSamples::kBackground));
  EXPECT_EQ(setup.samples.facing, std::vector<std::int8_t>(16, 0));
  EXPECT_EQ(setup.samples.p, std::vector<glm::vec3>(16, glm::vec3(0)));
}

TEST(ViewSamples, EqualDepthsGoToTheSmallerVertices) {
  // Two triangles in one plane cover the pixel: the one with the lexicographically smaller sorted vertices wins,
  // whatever their order.
  const tests::Corners small = {glm::dvec3(-3, -1, 0), glm::dvec3(1, -1, 0), glm::dvec3(0, 2, 0)};
  const tests::Corners large = {glm::dvec3(-1, -1, 0), glm::dvec3(1, -1, 0), glm::dvec3(0, 2, 0)};
  for (const bool swapped : {false, true}) {
    scenes::Scene scene;
    tests::add_object(scene, "a", swapped ? std::vector{large, small} : std::vector{small, large});
    scene.cameras.push_back(tests::camera({0, 0, 4}, {0, 0, 0}));
    scene.lights.push_back(tests::ceiling_light(9, 1));
    EXPECT_EQ(tests::Stage(scene, 1, 1).samples.triangle[0], swapped ? 1 : 0);
  }
}

TEST(Classify, EveryKindOfPixel) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}));
  tests::add_object(scene, "wall", tests::quad({3, 1, 0}, {1, 0, 0}, {0, 1, 0}));    // faces +z, cuts the light's rows
  tests::add_object(scene, "shelf", tests::quad({6, 7, 0}, {1, 0, 0}, {0, 0, -1}));  // above the light
  tests::add_object(scene, "lamp", tests::quad({9, 0, 0}, {1, 0, 0}, {0, 0, -1})).emits = 0;
  tests::add_object(scene, "sky", tests::quad({12, 0, 0}, {1, 0, 0}, {0, 0, -1})).receives_shadow = false;
  tests::add_object(scene, "sign", tests::quad({15, 0, 0}, {1, 0, 0}, {0, 0, -1})).emits = 1;
  tests::add_object(scene, "bulb", tests::quad({18, 7, 0}, {1, 0, 0}, {0, 0, -1})).emits = 1;
  scene.lights.push_back(tests::ceiling_light(5, 1));
  const SceneFloats floats = make_scene_floats(scene);
  const Light light = make_light(scene, 0, floats.origin, {});
  const auto class_at = [&](const glm::dvec3& eye, const glm::dvec3& target) {
    const PinholeCamera pinhole = make_camera(tests::camera(eye, target), floats.origin, 1, 1);
    return classify_pixels(floats, brute_force_view_samples(floats, pinhole), light)[0];
  };
  EXPECT_EQ(class_at({0.1, 3, 1}, {0.1, 0, 0.1}), PixelClass::judged);
  EXPECT_EQ(class_at({0.1, -3, 1}, {0.1, 0, 0.1}),
            PixelClass::horizon);  // seen from below: the light is below the visible side's horizon
  EXPECT_EQ(class_at({3.1, 1, 4}, {3.1, 1.2, 0}), PixelClass::horizon);
  EXPECT_EQ(class_at({6.1, 9, 1}, {6.1, 7, 0.1}), PixelClass::behind);
  EXPECT_EQ(class_at({9.1, 9, 1}, {9.1, 0, 0.1}), PixelClass::emitter);
  EXPECT_EQ(class_at({12.1, 9, 1}, {12.1, 0, 0.1}), PixelClass::unshadowed);
  EXPECT_EQ(class_at({15.1, 3, 1}, {15.1, 0, 0.1}), PixelClass::other_body);
  EXPECT_EQ(class_at({18.1, 9, 1}, {18.1, 7, 0.1}), PixelClass::behind)
      << "behind the light, and also the body of another light";
  EXPECT_EQ(class_at({0, 9, 0.5}, {50, 0, 50}), PixelClass::background);
}

TEST(Classify, LinkedLightsAndMeshes) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1})).lit_by = {1};
  tests::add_object(scene, "board", tests::quad({0, 1, 0}, {0.1, 0, 0}, {0, 0, -0.1}));
  scene.lights = {tests::ceiling_light(5, 1), tests::ceiling_light(5, 1)};
  scene.lights[1].unshaded_by = {1};
  const SceneFloats floats = make_scene_floats(scene);
  const PinholeCamera pinhole = make_camera(tests::camera({0.5, 3, 1}, {0.5, 0, 0.1}), floats.origin, 1, 1);
  const ViewSamples samples = brute_force_view_samples(floats, pinhole);
  const Light first = make_light(scene, 0, floats.origin, {}), second = make_light(scene, 1, floats.origin, {});
  EXPECT_EQ(classify_pixels(floats, samples, first)[0], PixelClass::unlit);
  EXPECT_EQ(classify_pixels(floats, samples, second)[0], PixelClass::judged);
  EXPECT_EQ(cast_for(floats, first).casts_shadow, (std::vector<std::uint8_t>{1, 1, 1, 1}));
  EXPECT_EQ(cast_for(floats, second).casts_shadow, (std::vector<std::uint8_t>{1, 1, 0, 0}));
}

TEST(Classify, AllOfASunsConeIsAboveOrNot) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}));
  scene.lights.emplace_back();
  const SceneFloats floats = make_scene_floats(scene);
  const PinholeCamera pinhole = make_camera(tests::camera({0.1, 3, 1}, {0.1, 0, 0.1}), floats.origin, 1, 1);
  const ViewSamples samples = brute_force_view_samples(floats, pinhole);
  const auto class_under = [&](double elevation, double angle) {
    const double e = glm::radians(elevation);
    scene.lights[0].shape = scenes::Sun{{-std::cos(e), -std::sin(e), 0}, angle};
    return classify_pixels(floats, samples, make_light(scene, 0, floats.origin, {}))[0];
  };
  EXPECT_EQ(class_under(90, 179), PixelClass::judged);
  EXPECT_EQ(class_under(20, 39.999), PixelClass::judged);
  EXPECT_EQ(class_under(20, 40.001), PixelClass::horizon);
  EXPECT_EQ(class_under(20, 0), PixelClass::judged);
  EXPECT_EQ(class_under(-20, 0), PixelClass::horizon);
  EXPECT_EQ(class_under(0, 0), PixelClass::horizon) << "along the plane is not strictly above it";
}

/// Suns whose cone touches the carrier's plane up to a few units in the last place of its width: double decides few of
/// them.
TEST(Classify, ASunsConeWithinRoundingOfThePlane) {
  using Number = CGAL::MP_Float;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> real(-1, 1);
  const auto vector = [&] { return glm::vec3(real(random), real(random), real(random)); };
  std::size_t above = 0, not_above = 0;
  for (int round = 0; round < 300; ++round) {
    scenes::Scene scene;
    tests::add_object(scene, "triangle", {{glm::dvec3(vector()), glm::dvec3(vector()), glm::dvec3(vector())}});
    scene.lights.emplace_back().shape = scenes::Sun{glm::dvec3(vector()), 30};
    const SceneFloats floats = make_scene_floats(scene);
    Light light = make_light(scene, 0, floats.origin, {});
    const auto corners = floats.corners(0);
    const auto height = [&](const glm::vec3& d) {
      std::array<Number, 3> e, f;
      for (int i = 0; i < 3; ++i) {
        e[static_cast<std::size_t>(i)] = Number(corners[1][i]) - Number(corners[0][i]);
        f[static_cast<std::size_t>(i)] = Number(corners[2][i]) - Number(corners[0][i]);
      }
      return (e[1] * f[2] - e[2] * f[1]) * Number(d.x) + (e[2] * f[0] - e[0] * f[2]) * Number(d.y) +
             (e[0] * f[1] - e[1] * f[0]) * Number(d.z);
    };
    const Number m = height(light.center), u = height(light.sun->axis_u), v = height(light.sun->axis_v);
    ViewSamples samples;
    samples.width = samples.height = 1;
    samples.triangle = {0};
    samples.p = {corners[0]};
    samples.n = {glm::vec3(0, 1, 0)};
    samples.depth = {1};
    samples.facing = {static_cast<std::int8_t>(CGAL::sign(m) == CGAL::POSITIVE ? 1 : -1)};
    const double touching = std::abs(CGAL::to_double(m)) / std::hypot(CGAL::to_double(u), CGAL::to_double(v));
    for (int units = -20; units <= 20; ++units) {
      light.sun->tangent = touching * (1 + units * 0x1p-52);
      const Number t(light.sun->tangent);
      const bool exact = CGAL::sign(m * m - t * t * (u * u + v * v)) == CGAL::POSITIVE;
      ++(exact ? above : not_above);
      EXPECT_EQ(classify_pixels(floats, samples, light)[0], exact ? PixelClass::judged : PixelClass::horizon)
          << "round " << round << ", " << units << " units";
    }
  }
  EXPECT_GT(above, 5000U);
  EXPECT_GT(not_above, 5000U);
}

TEST(Horizon, BulkAnswersAreTheExactOnes) {
  // Planes through lattice points; light points on these planes, next to them and far from them.
  std::mt19937 random(7);
  std::uniform_int_distribution<int> lattice(-2, 2);
  const auto point = [&] { return glm::vec3(lattice(random), lattice(random), lattice(random)); };
  int on_plane = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::array<glm::vec3, 3> carrier = {point(), point(), point()};
    if (collinear(carrier[0], carrier[1], carrier[2])) continue;
    std::vector<glm::vec3> points;
    for (int j = 0; j < 40; ++j) {
      glm::vec3 q = point();
      if (j % 3 == 0) q.x = std::nextafter(q.x, 9.0f);
      points.push_back(q);
    }
    const std::int8_t facing = round % 2 == 0 ? std::int8_t{1} : std::int8_t{-1};
    Light light;
    if (round % 4 > 1) light.sun = Light::Directions{};  // points are directions
    const HorizonTest horizon(light, carrier, facing, {glm::vec3(-2.001f), glm::vec3(2.001f)});
    std::array<std::uint32_t, 2> words{~0u, ~0u};
    horizon.mask(points, words);
    for (std::size_t j = 0; j < points.size(); ++j) {
      const bool above = above_horizon(light, carrier, facing, points[j]);
      if (light.sun) {
        const glm::dvec3 a(carrier[0]), n = glm::cross(glm::dvec3(carrier[1]) - a, glm::dvec3(carrier[2]) - a);
        const glm::dvec3 lattice_point = glm::round(glm::dvec3(points[j]));  // without the step of nextafter
        const double whole = glm::dot(n, lattice_point), rest = glm::dot(n, glm::dvec3(points[j]) - lattice_point);
        EXPECT_EQ(above, (whole != 0 ? whole : rest) * facing > 0);
      }
      EXPECT_EQ((words[j / 32] >> (j % 32)) & 1u, above ? 1u : 0u);
      on_plane += side_of_plane(carrier[0], carrier[1], carrier[2], points[j]) == Side::on ? 1 : 0;
    }
    EXPECT_EQ(words[1] >> 8, 0u) << "bits beyond the points are 0";
  }
  EXPECT_GT(on_plane, 1000);
}

}  // namespace
}  // namespace penumbra::visibility
