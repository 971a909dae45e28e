// SPDX-License-Identifier: Apache-2.0
// Compares the irregular z-buffer with exact predicates on each triangle: lattice soups, flawed meshes, shipped scenes,
// every kind of light, view samples all around the light.

#include "tests/agreement/differences.hpp"
#include "tests/agreement/lattice.hpp"
#include "tests/agreement/point_lights.hpp"
#include "tests/property/lattice_truth.hpp"
#include "tests/unit/shipped_scene.hpp"

#include "mesh/shapes/broken_meshes.hpp"
#include "vsm/methods.hpp"

namespace penumbra::vsm {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

struct Tally {
  std::size_t asked = 0, lit = 0, dark = 0, wrong = 0;
  std::string first_wrong;

  void operator+=(const Tally& other) {
    asked += other.asked;
    lit += other.lit;
    dark += other.dark;
    if (wrong == 0) first_wrong = other.first_wrong;
    wrong += other.wrong;
  }
};

/// Returns whether the light's centre is visible, by testing each triangle.
bool sees_center(const SceneFloats& floats, const ViewSamples& samples, std::size_t pixel, const Light& light) {
  const auto carrier = static_cast<std::uint32_t>(samples.triangle[pixel]);
  const glm::vec3 &p = samples.p[pixel], l = visibility::center_of(light);
  if (!visibility::above_horizon(light, floats.corners(carrier), samples.facing[pixel], l)) return false;
  if (!visibility::in_front_of_light(light, p)) return false;
  for (std::uint32_t i = 0; i < floats.triangles.size(); ++i) {
    if (!visibility::may_occlude(floats, light, carrier, i)) continue;
    if (visibility::segment_meets_triangle(p, l, floats.corners(i), light).meets) return false;
  }
  return true;
}

Tally compare(const SceneFloats& floats, const Light& light, const ViewSamples& samples,
              const visibility::MethodOptions& options = {}, std::uint32_t rows = 0) {
  const auto method = make_alias_free(options);
  const tests::Masks found = tests::run(*method, floats, light, samples, rows);
  std::vector<std::uint8_t> truth(samples.size(), 1);
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    if (visibility::is_receiver(floats, light, samples, i)) truth[i] = sees_center(floats, samples, i, light) ? 1 : 0;
  });
  Tally tally;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!visibility::is_receiver(floats, light, samples, i)) continue;
    ++tally.asked;
    ++(truth[i] != 0 ? tally.lit : tally.dark);
    if (found.visibility[i] == static_cast<float>(truth[i])) continue;
    if (tally.wrong++ > 0) continue;
    tally.first_wrong = fmt::format("pixel {}: V is {}, p {}, centre {}", i, found.visibility[i],
                                    tests::text_of(samples.p[i]), tests::text_of(visibility::center_of(light)));
  }
  return tally;
}

/// Compares a soup under one kind of light; kinds take turns: rectangle, sphere, sun and those of point_lights.
Tally compare_soup(std::uint32_t seed, int range) {
  tests::LatticeSoup soup(seed, range);
  visibility::SampleRequest request;
  scenes::Scene scene = tests::lattice_scene(soup, request);
  scenes::AreaLight& light = scene.lights[0];
  const glm::dvec3 center = std::get<scenes::Rectangle>(light.shape).center;
  switch (seed % 6) {
    case 0:
      light.shape = scenes::Sphere{center, 0.25 * (1 + soup.below(8))};
      break;
    case 1: {
      glm::dvec3 direction = soup.point();
      if (direction == glm::dvec3(0)) direction = {0, -1, 0};
      light.shape = scenes::Sun{direction, static_cast<double>(soup.below(3))};
      break;
    }
    case 2:
      tests::reshape(light, tests::PointLight::polygon, request, soup.random(), 20);
      break;
    case 3:
      tests::reshape(light, tests::PointLight::disk, request, soup.random(), 20);
      break;
    default:
      break;
  }
  const SceneFloats floats = visibility::make_scene_floats(scene);
  const Light made = visibility::make_light(scene, 0, floats.origin, request);
  const ViewSamples samples = tests::all_samples(scene, floats, soup.random());
  static constexpr std::array kPerPixel{"1", "0.125", "64"};
  return compare(floats, made, samples, {{"perPixel", kPerPixel.at(seed / 6 % 3)}});
}

void expect_soups(std::uint32_t first, std::uint32_t count) {
  Tally all;
  for (std::uint32_t seed = first; seed < first + count; ++seed) {
    const Tally one = compare_soup(seed, 1 << seed % 3);
    EXPECT_EQ(one.wrong, 0U) << "seed " << seed << ": " << one.first_wrong;
    all += one;
  }
  fmt::print("{} soups, {} view samples, {} of them see the centre\n", count, all.asked, all.lit);
  EXPECT_GT(all.lit, all.asked / 20);
  EXPECT_GT(all.dark, all.asked / 20);
}

TEST(AliasFree, LatticeSoupsUnderEveryKindOfLight) {
  expect_soups(0, 240);
}
TEST(AliasFreeFull, SixtyThousandLatticeSoups) {
  for (std::uint32_t first = 1000; first < 61'000 && !testing::Test::HasFailure(); first += 5000)
    expect_soups(first, 5000);
}

Tally compare_scene(const scenes::Scene& scene, std::uint32_t width, std::uint32_t height) {
  const tests::Stage stage(scene, width, height);
  return compare(stage.floats, stage.light, stage.samples);
}

TEST(AliasFree, ShippedScenes) {
  for (const char* name : {"broken", "contact", "parallel-square", "thin"}) {
    const Tally tally = compare_scene(tests::shipped_scene(name), 32, 24);
    EXPECT_EQ(tally.wrong, 0U) << name << ": " << tally.first_wrong;
    EXPECT_GT(tally.lit, 0U) << name;
    EXPECT_GT(tally.dark, 0U) << name;
  }
}

TEST(AliasFree, FlawedMeshes) {
  for (const char* defect : {"hole", "flipped-patch", "inside-out", "duplicate-face", "t-junction", "needle", "fin"}) {
    const scenes::Scene scene = tests::with_a_floor(mesh::make_broken_mesh({{defect}, 2, {0, 1, 0}, 1}).soup);
    const Tally tally = compare_scene(scene, 40, 30);
    EXPECT_EQ(tally.wrong, 0U) << defect << ": " << tally.first_wrong;
    EXPECT_GT(tally.dark, 0U) << defect;
  }
}

/// A sphere light in the middle of a room, seen through holes: all six faces of the map have view samples, and
/// triangles lie across the faces' borders.
TEST(AliasFree, AllAroundTheLight) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&] { return glm::dvec3(real(random), real(random), real(random)); };
  scenes::Scene scene;
  std::vector<tests::Corners> walls;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-4.0, 4.0}) {
      glm::dvec3 middle(0), u(0), v(0);
      middle[axis] = side;
      u[(axis + 1) % 3] = v[(axis + 2) % 3] = 4;
      for (const tests::Corners& corners : tests::quad(middle, u, v)) walls.push_back(corners);
    }
  }
  tests::add_object(scene, "walls", walls);
  std::vector<tests::Corners> soup;
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 a = 2.0 * point();
    soup.push_back({a, a + point(), a + point()});
  }
  tests::add_object(scene, "soup", soup);
  scene.lights.emplace_back();
  scene.lights[0].shape = scenes::Sphere{{0.1, 0.2, -0.1}, 0.05};
  const SceneFloats floats = visibility::make_scene_floats(scene);
  const Light light = visibility::make_light(scene, 0, floats.origin, {});
  const ViewSamples samples = tests::samples_on_triangles(floats, 64, 64, random);
  const Tally tally = compare(floats, light, samples);
  EXPECT_EQ(tally.wrong, 0U) << tally.first_wrong;
  EXPECT_GT(tally.lit, tally.asked / 10);
  EXPECT_GT(tally.dark, tally.asked / 10);
}

/// The occluder's shadow on the floor is the square, scaled by two from the light's centre: a closed form.
TEST(AliasFree, ASquareThrowsASquare) {
  const tests::Stage stage(tests::shipped_scene("parallel-square"), 120, 90);
  const auto method = make_alias_free({});
  const tests::Masks found = tests::run(*method, stage.floats, stage.light, stage.samples);
  std::size_t dark = 0;
  for (std::size_t i = 0; i < stage.samples.size(); ++i) {
    if (stage.samples.triangle[i] < 0 || stage.floats.object[static_cast<std::size_t>(stage.samples.triangle[i])] != 0)
      continue;
    const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
    const double distance = std::max(std::abs(p.x), std::abs(p.z)) - 1;
    if (std::abs(distance) < 1e-6) continue;  // p is off the floor by rounding, at most 2⁻²⁴ · 4
    EXPECT_EQ(found.visibility[i], distance < 0 ? 0.0F : 1.0F) << "pixel " << i;
    dark += distance < 0 ? 1 : 0;
  }
  EXPECT_GT(dark, 300U);
}

/// The grid limits the tests: far fewer pairs are tested than there are.
TEST(AliasFree, ListsAreShortAndTilesChangeNothing) {
  const tests::Stage stage(tests::with_a_floor(mesh::make_broken_mesh({{"hole"}, 4, {0, 1, 0}, 1}).soup), 64, 48);
  const auto method = make_alias_free({});
  const tests::Masks whole = tests::run(*method, stage.floats, stage.light, stage.samples);
  const std::uint64_t tested = method->counters().at("viewSamplesTested");
  const std::uint64_t all = std::uint64_t{stage.samples.size()} * stage.floats.triangles.size();
  fmt::print("{} view samples tested of {} pairs\n", tested, all);
  EXPECT_GT(tested, 0U);
  EXPECT_LT(tested, all / 50);
  EXPECT_EQ(tests::run(*method, stage.floats, stage.light, stage.samples, 7).visibility, whole.visibility);
}

TEST(AliasFree, UnknownOptionsAreRefused) {
  EXPECT_THROW(make_alias_free({{"bias", "0.1"}}), UsageError);
  EXPECT_THROW(make_alias_free({{"perPixel", "0"}}), UsageError);
}

}  // namespace
}  // namespace penumbra::vsm
