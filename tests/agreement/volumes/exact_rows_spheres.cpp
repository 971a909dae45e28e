// edge-scatter with rows=exact under spheres that casters reach into, as lamps have it whose own body does: areas of
// what is before the disk that each view sample sees, against integers.

#include "tests/agreement/cracked_ball.hpp"
#include "tests/agreement/volumes/exact_rows.hpp"
#include "tests/agreement/volumes/soft_stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace penumbra::volumes {
namespace {

using tests::ExactRows;
using visibility::Light;
using visibility::SceneFloats;

class SpheresThatHold : public ExactRows {
 protected:
  /// A floor, a sphere over it, and casters. The anchor keeps the origin of scene floats at zero, whatever they are.
  static void look(const glm::dvec3& at, double radius, const std::vector<tests::Corners>& casters,
                   std::mt19937& random, Found& found) {
    scenes::Scene scene;
    const double far = 8 + 2 * std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
    scenes::Object& anchor =
        tests::add_object(scene, "anchor", {{glm::dvec3(-far), glm::dvec3(far, far, -far), glm::dvec3(far)}});
    anchor.casts_shadow = anchor.receives_shadow = false;
    tests::add_object(scene, "floor", tests::quad(at, {2, 0.1, 0}, {0, 0.2, -2}));
    scene.lights.push_back(tests::rectangle_light(at, {1, 0, 0}, {0, 0, 1}));
    scene.lights[0].shape = scenes::Sphere{at + glm::dvec3(0, 2.5, 0), radius};
    tests::add_object(scene, "casters", casters);
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, {});
    compare(floats, light, tests::samples_on_triangles(floats, 6, 6, random, 1U), tests::kExactRowsTolerance, found);
  }
  static void expect_right(const char* name, const Found& found) {
    fmt::print("{}: {} view samples, {} partly lit, {} unproven, off by {:.1e} at most, form factors by {:.1e}\n", name,
               found.pixels, found.partly, found.unproven, found.largest, found.largest_form_factor);
    EXPECT_EQ(found.wrong, 0U);
    EXPECT_EQ(found.wrong_form_factors, 0U);
    EXPECT_GT(found.partly, found.pixels / 3);
  }
};

/// In general position double proves nearly all of them.
TEST_F(SpheresThatHold, Balls) {
  Found found;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const glm::dvec3 middle(0.5 * real(random), 1.6 + 0.4 * real(random), 0.5 * real(random));
    look({0, 0, 0}, 1.2, tests::cracked_ball(middle, 0.6, random), random, found);
  }
  expect_right("balls", found);
  EXPECT_LE(found.unproven, found.pixels / 100);
}

/// Triangles of any size and at any angle to the disk, far from zero, where all is rounded more.
TEST_F(SpheresThatHold, Triangles) {
  Found found;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const auto vector = [&] { return glm::dvec3(real(random), real(random), real(random)); };
    const glm::dvec3 at = seed % 2 == 0 ? glm::dvec3(0) : 300.0 * vector();
    std::vector<tests::Corners> casters;
    for (int i = 0; i < 20; ++i) {
      const glm::dvec3 middle = at + glm::dvec3(0, 2.4, 0) + 0.5 * vector();
      const double size = std::exp2(2 * real(random));
      // Every third one all but in the plane of a disk that is seen from below.
      const double flat = i % 3 == 0 ? 0.02 : 1;
      const auto corner = [&] { return middle + size * glm::dvec3(1, flat, 1) * vector(); };
      const glm::dvec3 a = corner(), b = corner(), c = corner();
      casters.push_back({a, b, c});
    }
    look(at, 0.7, casters, random, found);
  }
  expect_right("triangles", found);
  EXPECT_LE(found.unproven, found.pixels / 20);
}

/// A lamp in a shade: two cones around the sphere, the lower one through it, as they are modelled, in rings.
TEST_F(SpheresThatHold, LampShades) {
  Found found;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const double low = 2 + 0.3 * real(random), wide = 0.5 + 0.2 * real(random);
    const auto ring = [&](double y, double radius, int i) {
      const double a = i * std::numbers::pi / 12;
      return glm::dvec3(radius * std::cos(a), y, radius * std::sin(a));
    };
    std::vector<tests::Corners> shade;
    for (int i = 0; i < 24; ++i) {
      for (const auto& [y0, r0, y1, r1] : {std::array{low, wide, 2.4, 0.4}, std::array{2.4, 0.4, 3.5, 0.1}}) {
        shade.push_back({ring(y0, r0, i), ring(y0, r0, i + 1), ring(y1, r1, i + 1)});
        shade.push_back({ring(y0, r0, i), ring(y1, r1, i + 1), ring(y1, r1, i)});
      }
    }
    look({0, 0, 0}, 0.5, shade, random, found);
  }
  expect_right("shades", found);
  EXPECT_LE(found.unproven, found.pixels / 50);
}

/// Walls through the sphere whose edges are in no list, two of them; or one, and a ceiling that hides all of the light.
TEST_F(SpheresThatHold, Walls) {
  Found found;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1, 1);
    const glm::dvec3 u(20, real(random), real(random)), v(0.3 * real(random), 20, 20 * real(random));
    std::vector<tests::Corners> walls;
    for (const double z : {-0.2, 0.1}) {
      const std::vector<tests::Corners> wall = tests::quad({0, 2.5, z + 0.1 * real(random)}, u, v);
      walls.insert(walls.end(), wall.begin(), wall.end());
    }
    look({0, 0, 0}, 0.5, walls, random, found);
    const std::vector<tests::Corners> ceiling = tests::quad({0, 1.5, 0}, {20, 0, 0}, {0, 0, 20});
    std::copy(ceiling.begin(), ceiling.end(), walls.begin());
    Found hidden;
    look({0, 0, 0}, 0.5, walls, random, hidden);
    EXPECT_EQ(hidden.wrong, 0U);
    EXPECT_LE(hidden.unproven, 2U);
  }
  expect_right("walls", found);
  EXPECT_LE(found.unproven, found.pixels / 50);
}

}  // namespace
}  // namespace penumbra::volumes
