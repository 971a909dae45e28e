// SPDX-License-Identifier: Apache-2.0
#include "visibility/light_samples.hpp"

#include "base/error.hpp"
#include "tests/unit/visibility/scenes.hpp"
#include "visibility/pair_truth.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace penumbra::visibility {
namespace {

constexpr double kPi = std::numbers::pi;

template <typename Shape>
Light light_of(const Shape& shape, const SampleRequest& request = {}, const glm::dvec3& origin = glm::dvec3(0)) {
  scenes::Scene scene;
  scene.lights.emplace_back();
  scene.lights.back().name = "key";
  scene.lights.back().shape = shape;
  return make_light(scene, 0, origin, request);
}

std::string refusal(const auto& shape) {
  try {
    light_of(shape);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Lights, RectanglePointsAreWorldMinusOriginRoundedOnce) {
  const scenes::Rectangle shape{{1000.1, 5, -3}, {0.3, 0, 0.1}, {0, 0.2, 0.7}};
  const glm::dvec3 origin(999.7, 1, 0.2);
  const Light light = light_of(shape, {35, 0, 0, SamplePattern::rows, 0}, origin);
  EXPECT_EQ(light.rows, 6u);
  EXPECT_EQ(light.columns, 6u);
  EXPECT_EQ(light.row_shift.size(), 6u);
  ASSERT_EQ(light.sample_count(), 36u);
  EXPECT_EQ(light.words_per_mask(), 2u);
  const auto unit = unit_square_samples({35, 0, 0, SamplePattern::rows, 0});
  for (std::size_t j = 0; j < 36; ++j) {
    EXPECT_EQ(light.coordinates[j], 2.0 * unit[j] - 1.0);
    const glm::dvec3 world =
        shape.center + light.coordinates[j].x * shape.half_u + light.coordinates[j].y * shape.half_v;
    EXPECT_EQ(light.points[j], glm::vec3(world - origin));
  }
  EXPECT_NEAR(light.area, 4 * glm::length(glm::cross(shape.half_u, shape.half_v)), 1e-12);
  EXPECT_EQ(light.outline.size(), 4u);
  EXPECT_EQ(light.center_u, glm::vec3(shape.center + shape.half_u - origin));
}

TEST(Lights, RoundingTheCountIsSaid) {
  scenes::Scene scene;
  scene.lights.push_back(tests::ceiling_light(5, 1));
  std::vector<std::string> notes;
  make_light(scene, 0, glm::dvec3(0), {35, 0, 0, SamplePattern::rows, 0}, &notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0], "light samples: 35 rounded up to 6 rows of 6 = 36 by pattern rows");
  make_light(scene, 0, glm::dvec3(0), {0, 5, 7, SamplePattern::rgss, 0}, &notes);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[1], "light samples: 35 rounded up to 3 x 4 squares of four = 48 by pattern rgss");
  notes.clear();
  make_light(scene, 0, glm::dvec3(0), {35, 0, 0, SamplePattern::sobol, 0}, &notes);
  make_light(scene, 0, glm::dvec3(0), {256, 0, 0, SamplePattern::rgss, 0}, &notes);
  make_light(scene, 0, glm::dvec3(0), {36, 0, 0, SamplePattern::grid, 0}, &notes);
  make_light(scene, 0, glm::dvec3(0), {0, 5, 7, SamplePattern::rows, 0}, &notes);
  EXPECT_TRUE(notes.empty());
}

TEST(Lights, EachEmitsToTheSideItsShapeSays) {
  const glm::vec3 above(0.2f, 9, 0.1f), below(0.2f, 1, 0.1f);
  const auto check = [&](const Light& light) {
    EXPECT_TRUE(in_front_of_light(light, below));
    EXPECT_FALSE(in_front_of_light(light, above));
    EXPECT_FALSE(in_front_of_light(light, light.center)) << "on its plane is not strictly in front";
  };
  check(light_of(scenes::Rectangle{{0, 5, 0}, {1, 0, 0}, {0, 0, 1}}));
  check(light_of(scenes::Disk{{0, 5, 0}, {0, -3, 0}, 0.5}));
  check(light_of(scenes::Polygon{{{0, 5, 0}, {1, 5, 0}, {2, 5, 0}, {0, 5, 1}}}));
  Light both = light_of(scenes::Rectangle{{0, 5, 0}, {1, 0, 0}, {0, 0, 1}});
  both.two_sided = true;
  EXPECT_TRUE(in_front_of_light(both, above) && in_front_of_light(both, below));
  EXPECT_FALSE(in_front_of_light(both, {7, 5, 3}));
}

TEST(Lights, DiskSamplesKeepAreas) {
  for (const glm::dvec3 normal : {glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1), glm::dvec3(1, 2, -3)}) {
    const Light light = light_of(scenes::Disk{{1, 2, 3}, normal, 2}, {4096, 0, 0, SamplePattern::grid, 0});
    EXPECT_NEAR(light.area, 4 * kPi, 1e-12);
    std::size_t inner = 0;
    for (std::size_t j = 0; j < light.points.size(); ++j) {
      const glm::dvec3 d = glm::dvec3(light.points[j]) - glm::dvec3(1, 2, 3);
      EXPECT_LE(glm::length(d), 2 + 1e-6);
      EXPECT_NEAR(glm::dot(d, glm::normalize(normal)), 0, 1e-5);
      inner += glm::length(light.coordinates[j]) < std::sqrt(0.5) ? 1 : 0;  // the circle that contains half of the area
    }
    EXPECT_NEAR(static_cast<double>(inner) / 4096, 0.5, 4.0 / 64);
    const glm::vec3 frame = glm::cross(light.center_u - light.center, light.center_v - light.center);
    EXPECT_GT(glm::dot(glm::dvec3(frame), normal), 0);
  }
}

/// Four neighbours in the grid are the corners of 1 / 4096 of the disk's area, anywhere on the disk. Replacing arcs of
/// dφ by chords makes that smaller by dφ² / 6; at a quarter of the radius dφ is 0.1.
TEST(Lights, DiskSamplesAreSpreadEvenly) {
  const Light light = light_of(scenes::Disk{{1, 2, 3}, {0, -1, 0}, 2}, {4096, 0, 0, SamplePattern::grid, 0});
  const auto at = [&](std::size_t row, std::size_t column) { return light.coordinates[64 * row + column]; };
  for (std::size_t row = 0; row + 1 < 64; ++row) {
    for (std::size_t column = 0; column + 1 < 64; ++column) {
      if (row == column || row + column == 62) continue;  // the map bends at the diagonals
      const glm::dvec2 middle = at(row, column), diagonal = at(row + 1, column + 1) - middle,
                       other = at(row + 1, column) - at(row, column + 1);
      if (glm::length(middle) < 0.25) continue;
      EXPECT_NEAR(std::abs(diagonal.x * other.y - diagonal.y * other.x) / 2 / (kPi / 4096), 1, 0.004);
    }
  }
}

TEST(Lights, EllipseSamplesAreADisksInTheEllipsesFrame) {
  const SampleRequest request{1000, 0, 0, SamplePattern::sobol, 3};
  const scenes::Ellipse shape{{1, 2, 3}, {0.5, 0.25, 2}, {1, -0.125, 0.25}};
  const Light light = light_of(shape, request), disk = light_of(scenes::Disk{{1, 2, 3}, {0, -1, 0}, 2}, request);
  EXPECT_EQ(light.kind, LightKind::ellipse);
  EXPECT_NEAR(light.area, kPi * glm::length(glm::cross(shape.half_u, shape.half_v)), 1e-12);
  EXPECT_EQ(light.coordinates, disk.coordinates);
  ASSERT_EQ(light.points.size(), 1000u);
  for (std::size_t j = 0; j < light.points.size(); ++j) {
    const auto [s, t] = std::pair(light.coordinates[j].x, light.coordinates[j].y);
    EXPECT_LE(std::hypot(s, t), 1);
    EXPECT_EQ(light.points[j], glm::vec3(shape.center + s * shape.half_u + t * shape.half_v));
  }
  EXPECT_EQ(light.outline[2], glm::vec3(shape.center + shape.half_u + shape.half_v));
  const glm::dvec3 front = glm::cross(shape.half_u, shape.half_v);
  EXPECT_TRUE(in_front_of_light(light, glm::vec3(shape.center + front)));
  EXPECT_FALSE(in_front_of_light(light, glm::vec3(shape.center - front)));
}

/// A corner in the middle of a side is off that side by its rounding error: a plane through the side's three corners
/// could have any direction.
TEST(Lights, RoundingChoosesNoPolygonsPlane) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> real(-1, 1);
  const auto vector = [&] { return glm::dvec3(real(random), real(random), real(random)); };
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 n = glm::normalize(vector()), u = glm::normalize(glm::cross(n, vector())), v = glm::cross(n, u);
    const double size = std::pow(10.0, -1.5 + 1.5 * real(random));
    const glm::dvec3 c = vector(), a = c - size * u - size * v, b = c + size * u - size * v;
    const Light light =
        light_of(scenes::Polygon{{a, 0.5 * a + 0.5 * b, b, c + size * u + size * v, c - size * u + size * v}});
    const glm::dvec3 stored(light.center),
        normal = glm::cross(glm::dvec3(light.center_u) - stored, glm::dvec3(light.center_v) - stored);
    // The light's corners are off by √3 2⁻²⁵, and its triangles are more than half of `size` high.
    EXPECT_GT(glm::dot(glm::normalize(normal), n), std::cos(std::min(0.3, 8 * 0x1p-25 * std::sqrt(3) / size))) << i;
    // The first three corners that are well apart: a test that looks for three corners not exactly on a line finds the
    // same.
    const Light plain = light_of(scenes::Polygon{{a, b, c + size * u + size * v, c - size * u + size * v}});
    EXPECT_EQ(plain.center, plain.outline[0]);
    EXPECT_EQ(plain.center_u, plain.outline[1]);
    EXPECT_EQ(plain.center_v, plain.outline[2]);
  }
}

TEST(Lights, PolygonSamplesKeepAreasAndStayInside) {
  const scenes::Polygon house{{{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 4, 0}, {0, 2, 0}}};  // area 8 + 4
  const Light light = light_of(house, {4096, 0, 0, SamplePattern::sobol, 1});
  EXPECT_NEAR(light.area, 12, 1e-12);
  EXPECT_EQ(light.outline.size(), 5u);
  std::size_t roof = 0, left = 0;
  for (std::size_t j = 0; j < light.points.size(); ++j) {
    const glm::vec3 q = light.points[j];
    EXPECT_TRUE(q.x >= 0 && q.x <= 4 && q.y >= 0 && q.y <= 4 && q.x + q.y <= 6.00001f && q.y - q.x <= 2.00001f);
    EXPECT_TRUE(std::abs(light.coordinates[j].x) <= 1 && std::abs(light.coordinates[j].y) <= 1);
    roof += q.y > 2 ? 1 : 0;
    left += q.x < 2 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(roof) / 4096, 4.0 / 12, 0.005);
  EXPECT_NEAR(static_cast<double>(left) / 4096, 0.5, 0.005);
}

/// The part of a sphere that p sees lies in the cone of angle asin(r / d); the disk's rim touches the sphere and that
/// cone.
TEST(Lights, SphereShowsEachPointTheDiskThatItsTangentsBound) {
  const double r = 0.5;
  const Light light = light_of(scenes::Sphere{{0, 4, 2}, r}, {256, 0, 0, SamplePattern::grid, 0});
  EXPECT_TRUE(light.points.empty());
  ASSERT_EQ(light.sample_count(), 256u);
  const glm::dvec3 c = light.center;
  std::vector<glm::vec3> points(256), again(256);
  for (const glm::vec3 p :
       {glm::vec3(0), glm::vec3(3, -1, 2), glm::vec3(0, 4, 7), glm::vec3(0, 3.49f, 2), glm::vec3(300, 20, -1000)}) {
    light_points_for(light, p, points.data());
    light_points_for(light, p, again.data());
    EXPECT_EQ(points, again);
    EXPECT_TRUE(in_front_of_light(light, p));
    const glm::dvec3 q = glm::dvec3(p) - c;
    const double d = glm::length(q), sine = r / d, cosine = std::sqrt(1 - sine * sine);
    const LightFrame frame = light_frame_from(light, p);
    EXPECT_GT(glm::dot(glm::cross(frame.u, frame.v), q), 0);
    EXPECT_NEAR(glm::dot(frame.u, frame.v), 0, 1e-15);
    for (int i = 0; i < 16; ++i) {
      const double angle = 2 * kPi * i / 16;
      const glm::dvec3 rim = frame.center + std::cos(angle) * frame.u + std::sin(angle) * frame.v,
                       toward = glm::dvec3(p) - rim;
      EXPECT_NEAR(glm::length(rim - c), r, 1e-14);
      EXPECT_NEAR(glm::dot(toward, rim - c), 0, 1e-14 * d);  // the line touches the sphere there
      EXPECT_NEAR(glm::dot(toward, q), glm::length(toward) * d * cosine, 1e-14 * d * d);
    }
    const double disk = r * cosine;
    for (std::size_t j = 0; j < points.size(); ++j) {
      const glm::dvec3 l = points[j],
                       exact = frame.center + light.coordinates[j].x * frame.u + light.coordinates[j].y * frame.v;
      EXPECT_EQ(points[j], glm::vec3(exact));  // rounded once
      EXPECT_LE(glm::length(exact - frame.center), disk * (1 + 1e-15));
      EXPECT_LE(glm::length(l - c), r + 1e-6);
    }
  }
}

/// The cosines are 0.8 and 0.6 at the cone's ends and 0.65 in p's direction: a quarter of the way in from the dark end.
TEST(Lights, ConesFallAsTheirLampsSay) {
  const double inner = glm::degrees(std::acos(0.8)), outer = glm::degrees(std::acos(0.6));
  const glm::vec3 p(static_cast<float>(std::sqrt(1 - 0.65 * 0.65)), -0.65F, 0), up(0, 1, 0);
  scenes::Sphere spot{{0, 0, 0}, 1e-5, scenes::Cone{{0, -1, 0}, inner, outer}};
  EXPECT_NEAR(spot_share(light_of(spot, {4}), p, up), 0.25 * 0.25, 1e-6);
  spot.cone->smooth = true;
  const Light light = light_of(spot, {4});
  EXPECT_NEAR(spot_share(light, p, up), 0.65 * 0.25 * 0.25 * (3 - 2 * 0.25), 1e-4);
  EXPECT_NEAR(spot_share(light, {0, -3, 0}, up), 1, 1e-9);
  EXPECT_EQ(spot_share(light, {1, -0.7F, 0}, up), 0);
}

/// Returns, by summing over a fine grid, the light that p gets from a disk that faces it, divided by the light that p
/// would get if all of it came from the disk's middle.
double share_by_grid(const scenes::Sphere& lamp, const glm::dvec3& p, const glm::dvec3& n) {
  const glm::dvec3 axis = lamp.cone->direction, middle = lamp.center - p, away = glm::normalize(middle);
  const glm::dvec3 u = glm::normalize(glm::cross(away, glm::dvec3(0.3, 0.5, 0.7))), v = glm::cross(away, u);
  const double full = std::cos(glm::radians(lamp.cone->inner)), dark = std::cos(glm::radians(lamp.cone->outer));
  double sum = 0;
  int points = 0;
  constexpr int kSide = 400;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = (2.0 * (i % kSide) + 1) / kSide - 1, y = (2.0 * (i / kSide) + 1) / kSide - 1;
    if (x * x + y * y > 1) continue;
    ++points;
    const glm::dvec3 toward = middle + lamp.radius * (x * u + y * v);
    const double length = glm::length(toward), c = -glm::dot(toward, axis) / length;
    const double t = glm::clamp((c - dark) / std::max(full - dark, 0.001), 0.0, 1.0);
    const double there = glm::dot(toward, away) / length, here = std::max(glm::dot(toward, n), 0.0) / length;
    sum += there * here / (length * length) * c * t * t * (3 - 2 * t);
  }
  return sum / points * glm::dot(middle, middle) / glm::dot(away, n);
}

/// Wide, narrow and hard edges; lamps that are small, large and larger than their distance; tilted surfaces.
TEST(Lights, ConesOfWideLampsAreThoseOfTheirDisks) {
  int between = 0;
  for (const double radius : {0.01, 0.25, 1.5}) {
    for (const double inner : {24.99, 20.0, 5.0}) {
      const scenes::Sphere spot{
          {0.5, 2, 0}, radius, scenes::Cone{glm::normalize(glm::dvec3(0.2, -1, 0.1)), inner, 25, true}};
      for (const glm::vec3 p :
           {glm::vec3(1, 0, 0), glm::vec3(1.7F, 0, 0.2F), glm::vec3(1.9F, 0, 0.2F), glm::vec3(0, 0, 1)}) {
        const glm::vec3 n = glm::normalize(glm::vec3(0.2F, 1, -0.3F));
        const double wanted = share_by_grid(spot, p, n), found = spot_share(light_of(spot, {4}), p, n);
        EXPECT_NEAR(found, wanted, radius > 1 ? 8e-3 : 1e-3) << radius << ' ' << inner << ' ' << p.x;
        between += wanted > 0.05 && wanted < 0.7 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(between, 9);
}

/// A part of the disk holds a share of the samples equal to the part's share of the area.
TEST(Lights, SphereSamplesKeepAreasOfTheDisk) {
  const Light light = light_of(scenes::Sphere{{0, 0, 0}, 1}, {4096, 0, 0, SamplePattern::sobol, 4});
  std::vector<glm::vec3> points(4096);
  light_points_for(light, {0, -1.25f, 0}, points.data());  // sees the disk at y = −0.8, of radius 0.6
  std::size_t inner = 0, right = 0;
  for (const glm::vec3& l : points) {
    EXPECT_NEAR(l.y, -0.8, 1e-6);
    inner += std::hypot(l.x, l.z) < 0.3f ? 1 : 0;
    right += l.x > 0.3f ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(inner) / 4096, 0.25, 0.005);
  EXPECT_NEAR(static_cast<double>(right) / 4096, (std::acos(0.5) - 0.5 * std::sqrt(0.75)) / kPi, 0.005);
}

TEST(Lights, InsideASphereNothingShines) {
  const Light light = light_of(scenes::Sphere{{1, 2, 3}, 0.5}, {64, 0, 0, SamplePattern::grid, 0});
  std::vector<glm::vec3> points(64);
  for (const glm::vec3 p : {glm::vec3(1, 2, 3), glm::vec3(1.25f, 2, 3), glm::vec3(1.5f, 2, 3), glm::vec3(1, 1.5f, 3)}) {
    EXPECT_FALSE(in_front_of_light(light, p)) << "a point in or on the sphere is not in front of it";
    light_points_for(light, p, points.data());
    for (const glm::vec3& l : points) EXPECT_EQ(l, light.center);
  }
  // 0.3² + 0.4² would be 0.25, but 0.3 and 0.4 are rounded to floats: the point is so near the sphere that double
  // cannot decide.
  EXPECT_TRUE(in_front_of_light(light, {1.0f + 0x1.333334p-2f, 2.0f + 0x1.99999ap-2f, 3}));
  EXPECT_TRUE(in_front_of_light(light, {std::nextafter(1.5f, 2.0f), 2, 3}));
  EXPECT_FALSE(in_front_of_light(light, {std::nextafter(1.5f, 1.0f), 2, 3}));
  // The radius is a double: it can be nearer to the point's distance than neighbouring floats are to one another.
  for (const double off : {0x1p-34, 0x1p-48, 0x1p-52}) {
    EXPECT_FALSE(in_front_of_light(light_of(scenes::Sphere{{0, 0, 0}, 1 + off}), {1, 0, 0})) << off;
    EXPECT_TRUE(in_front_of_light(light_of(scenes::Sphere{{0, 0, 0}, 1 - off}), {1, 0, 0})) << off;
  }
}

/// Directions: middle + tan(angle / 2) · disk, each rounded once.
TEST(Lights, SunSamplesAreDirectionsOverItsDisk) {
  const SampleRequest request{1024, 0, 0, SamplePattern::sobol, 3};
  for (const double angle : {1e-3, 0.53, 30.0, 170.0}) {
    const glm::dvec3 travels = glm::normalize(glm::dvec3(-0.35, -0.87, -0.35));
    const Light light = light_of(scenes::Sun{travels, angle}, request, {100, 200, 300});
    EXPECT_EQ(light.kind, LightKind::sun);
    EXPECT_EQ(light.center, glm::vec3(-travels)) << "the scene's origin must not change a direction";
    const double tangent = std::tan(glm::radians(angle) / 2);
    EXPECT_EQ(light.sun->tangent, tangent);
    EXPECT_NEAR(light.area, kPi * tangent * tangent, 1e-12 * light.area);
    EXPECT_LT(glm::dot(light.sun->axis_u, light.sun->axis_v), 1e-6f);
    EXPECT_GT(glm::dot(glm::dvec3(glm::cross(light.sun->axis_u, light.sun->axis_v)), travels), 0.999999);
    std::size_t inner = 0;
    for (std::size_t j = 0; j < light.points.size(); ++j) {
      const glm::dvec3 d = light.points[j];
      const double along = -glm::dot(d, travels);
      // Each coordinate is rounded once, by at most half an ulp, and is no longer than the direction.
      const double off = std::sqrt(3.0) * 0x1p-24 * glm::length(d);
      EXPECT_NEAR(along, 1, off);
      EXPECT_LE(glm::length(d + along * travels), tangent + 2 * off);
      inner += glm::length(light.coordinates[j]) < std::sqrt(0.5) ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(inner) / 1024, 0.5, 0.01);
    EXPECT_TRUE(in_front_of_light(light, {1, 2, 3}));
  }
}

TEST(Lights, ASunOfAngleZeroIsOneDirection) {
  const Light light = light_of(scenes::Sun{{0, -1, 0}, 0}, {9, 3, 3, SamplePattern::grid, 0});
  ASSERT_EQ(light.points.size(), 9u);
  for (const glm::vec3& d : light.points) EXPECT_EQ(d, glm::vec3(0, 1, 0));
  EXPECT_EQ(light.area, 0);
  for (const double angle : {-1.0, 180.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_NE(refusal(scenes::Sun{{0, -1, 0}, angle}).find("angle"), std::string::npos) << angle;
  EXPECT_NE(refusal(scenes::Sun{{0, 0, 0}, 1}).find("direction"), std::string::npos);
}

TEST(Lights, RefusesWhatHasNoAreaOrIsNotFinite) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(scenes::Rectangle{{0, 5, 0}, {1, 0, 0}, {2, 0, 0}}).find("light \"key\": its area is zero"),
            std::string::npos);
  EXPECT_NE(refusal(scenes::Rectangle{{1e9, 5, 0}, {1, 0, 0}, {0, 0, 1}}).find("in float32"), std::string::npos);
  EXPECT_NE(refusal(scenes::Ellipse{{0, 5, 0}, {1, 0, 0}, {2, 0, 0}}).find("parallel"), std::string::npos);
  EXPECT_NE(refusal(scenes::Disk{{0, 0, 0}, {0, 1, 0}, 0}).find("radius"), std::string::npos);
  EXPECT_NE(refusal(scenes::Disk{{0, 0, 0}, {0, 0, 0}, 1}).find("normal"), std::string::npos);
  EXPECT_NE(refusal(scenes::Polygon{{{0, 0, 0}, {1, 0, 0}}}).find("three corners"), std::string::npos);
  EXPECT_NE(refusal(scenes::Polygon{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}}).find("on a line"), std::string::npos);
  EXPECT_NE(refusal(scenes::Sphere{{0, 0, 0}, -1}).find("radius"), std::string::npos);
  for (const double bad : {inf, nan, 1e200}) {
    EXPECT_NE(refusal(scenes::Rectangle{{bad, 5, 0}, {1, 0, 0}, {0, 0, 1}}), "") << bad;
    EXPECT_NE(refusal(scenes::Disk{{0, bad, 0}, {0, 1, 0}, 1}), "") << bad;
    EXPECT_NE(refusal(scenes::Ellipse{{0, 5, 0}, {bad, 0, 0}, {0, 0, 1}}), "") << bad;
    EXPECT_NE(refusal(scenes::Polygon{{{0, 0, 0}, {bad, 0, 0}, {0, 1, 0}}}), "") << bad;
    EXPECT_NE(refusal(scenes::Sphere{{0, 0, bad}, 1}), "") << bad;
  }
}

}  // namespace
}  // namespace penumbra::visibility
