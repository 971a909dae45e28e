// SPDX-License-Identifier: Apache-2.0
// Exact areas by edge-scatter (rows=exact) under spheres that casters reach into, as the body of a lamp does. A view
// sample sees such a sphere as a disk; the area of what lies in front of the disk is compared with integer arithmetic.

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
using visibility::ViewSamples;

class SpheresThatHold : public ExactRows {
 protected:
  /// Compares a floor with a sphere over it and casters. The anchor keeps the origin of scene floats at zero, whatever
  /// these are.
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

/// Double arithmetic proves nearly all areas in general position.
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

/// Triangles of any size and at any angle to the disk, far from the origin, where rounding errors are larger.
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
      // Every third triangle is nearly in the plane of a disk seen from below.
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

/// Lampshades as modellers make them: two cones of rings around the sphere, the lower of which passes through it.
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

/// Two walls through the sphere, so large that no list has their edges; or one wall, and a ceiling that hides all of
/// the light.
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

/// Returns a scene whose sphere and casters have coordinates that are multiples of a half.
scenes::Scene halves_in_a_sphere(std::mt19937& random) {
  const auto half = [&](int low, int high) {
    return 0.5 * (low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1)));
  };
  scenes::Scene scene;
  scene.origin = glm::dvec3(0);
  tests::add_object(scene, "floor", tests::quad({0, -1, 0}, {2, 0, 0}, {0, 0, -2}));
  scene.lights.push_back(tests::rectangle_light({0, 0, 0}, {1, 0, 0}, {0, 0, 1}));
  scene.lights[0].shape =
      scenes::Sphere{{half(-1, 1), half(1, 3), half(-1, 1)}, 0.5 * static_cast<double>(1 + random() % 2)};
  std::vector<tests::Corners> casters;
  const auto corner = [&] { return glm::dvec3(half(-2, 2), half(0, 4), half(-2, 2)); };
  for (int i = 0; i < 6; ++i) {
    const glm::dvec3 a = corner(), b = corner(), c = corner();
    casters.push_back({a, b, c});
  }
  tests::add_object(scene, "casters", casters);
  return scene;
}
ViewSamples on_halves(const SceneFloats& floats, std::mt19937& random) {
  ViewSamples samples = tests::samples_on_triangles(floats, 8, 2, random, 0U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.triangle[i] != ViewSamples::kBackground) samples.p[i] = 0.25F * glm::round(4.0F * samples.p[i]) + 0.0F;
  }
  return samples;
}

TEST_F(SpheresThatHold, Halves) {
  Found found;
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    std::mt19937 random(seed);
    const scenes::Scene scene = halves_in_a_sphere(random);
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, {});
    SCOPED_TRACE(seed);
    compare(floats, light, on_halves(floats, random), tests::kExactRowsTolerance, found);
  }
  expect_right("halves", found);
}

/// A view sample gets the same bits alone and among others, whichever edges the lists of its neighbours have.
TEST_F(SpheresThatHold, NeighboursDoNotMatter) {
  std::size_t partly = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const scenes::Scene scene = halves_in_a_sphere(random);
    const SceneFloats floats = visibility::make_scene_floats(scene);
    const Light light = visibility::make_light(scene, 0, floats.origin, {});
    const ViewSamples samples = on_halves(floats, random);
    const auto method = make();
    const Answer together = run(*method, floats, light, samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      ViewSamples one;
      one.width = one.height = 1;
      one.triangle = {samples.triangle[i]};
      one.p = {samples.p[i]};
      one.n = {samples.n[i]};
      one.depth = {samples.depth[i]};
      one.facing = {samples.facing[i]};
      const Answer alone = run(*method, floats, light, one);
      EXPECT_EQ(alone.shares[0], together.shares[i]) << seed << " " << i;
      EXPECT_EQ(alone.form_factors[0], together.form_factors[i]) << seed << " " << i;
      partly += alone.shares[0] > 0 && alone.shares[0] < 1 ? 1 : 0;
    }
  }
  EXPECT_GT(partly, 200U);
}

/// An edge's end at the disk and its caster's cut were an ulp apart, on opposite sides of the window's left side: V was
/// 0.44 in place of 0.96.
TEST_F(SpheresThatHold, AnOutlineAtTheLeftSide) {
  scenes::Scene scene;
  scene.origin = glm::dvec3(0);
  scenes::Object& anchor =
      tests::add_object(scene, "anchor", {{glm::dvec3(-16), glm::dvec3(16, 16, -16), glm::dvec3(16)}});
  anchor.casts_shadow = anchor.receives_shadow = false;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}));
  tests::add_object(
      scene, "caster",
      {{glm::dvec3(-0.713833332F, 0.0435807705F, 2.13435411F), glm::dvec3(0.322484528F, -0.252617111F, 0.259244204F),
        glm::dvec3(0.422728151F, -0.455461264F, 1.70074689F)}});
  scene.lights.push_back(tests::rectangle_light({0, 0, 2.5}, {1, 0, 0}, {0, 1, 0}));
  scene.lights[0].shape = scenes::Sphere{{0, 0, 2.5}, 0.8};
  const SceneFloats floats = visibility::make_scene_floats(scene);
  const Light light = visibility::make_light(scene, 0, floats.origin, {});
  std::mt19937 random(1);
  ViewSamples samples = tests::samples_on_triangles(floats, 8, 1, random, 1U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.triangle[i] != ViewSamples::kBackground) samples.p[i] = {0.37F, -0.23F, 0};
  }
  Found found;
  compare(floats, light, samples, tests::kExactRowsTolerance, found);
  expect_right("left side", found);
  EXPECT_EQ(found.unproven, 0U);
}

/// A panel that nearly lies in the disk's plane, with a corner within rounding of that plane: rounding decides where
/// the panel passes through the plane.
TEST_F(SpheresThatHold, PanelsInTheDisk) {
  for (const double below : {-1e-12, -3e-13, -2.5e-13, -1e-13, 0.0, 2e-13}) {
    for (const double above : {4e-13, 5e-13, 1e-12, 1e-9, 0.0}) {
      scenes::Scene scene;
      scene.origin = glm::dvec3(0);
      scenes::Object& anchor =
          tests::add_object(scene, "anchor", {{glm::dvec3(-16), glm::dvec3(16, 16, -16), glm::dvec3(16)}});
      anchor.casts_shadow = anchor.receives_shadow = false;
      tests::add_object(scene, "floor", tests::quad({0, -3, 0}, {2, 0, 0}, {0, 0, -2}));
      tests::add_object(scene, "panel",
                        {{glm::dvec3(-2, below, 0), glm::dvec3(2.5, above, -1.5), glm::dvec3(2.5, above, 1.5)}});
      scene.lights.push_back(tests::rectangle_light({0, 1, 0}, {1, 0, 0}, {0, 0, 1}));
      scene.lights[0].shape = scenes::Sphere{{0, 1, 0}, 2};
      const SceneFloats floats = visibility::make_scene_floats(scene);
      const Light light = visibility::make_light(scene, 0, floats.origin, {});
      std::mt19937 random(1);
      ViewSamples samples = tests::samples_on_triangles(floats, 8, 1, random, 1U);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples.triangle[i] != ViewSamples::kBackground) samples.p[i] = {0, -3, 0};
      }
      Found found;
      SCOPED_TRACE(fmt::format("{} {}", below, above));
      compare(floats, light, samples, tests::kExactRowsTolerance, found);
      EXPECT_EQ(found.wrong, 0U);
      EXPECT_GT(found.pixels, 0U);
    }
  }
}

}  // namespace
}  // namespace penumbra::volumes
