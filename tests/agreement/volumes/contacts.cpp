// SPDX-License-Identifier: Apache-2.0
// Tests edge-scatter with casters a thousand times nearer to their shadow than to the light: neighbouring view samples
// in a small part of a large scene. All bits and all areas are compared with the exact ones; under rectangles also
// those of the other methods that promise every bit.

#include "tests/agreement/volumes/exact_rows.hpp"
#include "tests/agreement/mask_methods.hpp"

#include <array>
#include <random>

namespace penumbra::volumes {
namespace {

using visibility::Light;
using visibility::SceneFloats;
using visibility::ViewSamples;

constexpr int kFew = 8, kFan = 256;

/// Returns casters within `near` of (0, 0, 0) on the floor, a camera that sees only the floor, and a triangle far away
/// that makes the scene's largest coordinate `far`.
scenes::Scene contact(double near, double far, std::mt19937& random) {
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&] { return glm::dvec3(real(random), real(random), real(random)); };
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  std::vector<tests::Corners> casters;
  for (int i = 0; i < kFew; ++i) {
    const glm::dvec3 middle = near * (point() + glm::dvec3(0, 1.5, 0));
    const double size =
        near *
        std::ldexp(1.0, -static_cast<int>(random() % 13));  // some are smaller than the part that a sun covers there
    casters.push_back({middle + size * point(), middle + size * point(), middle + size * point()});
  }
  // A fan whose rim has edges as short as those of a dense mesh: each sample in a row of light samples crosses a
  // different one.
  const glm::dvec3 middle = near * (point() + glm::dvec3(0, 1.5, 0)), apex = middle + near * point();
  const glm::dvec3 first = middle + near * point(), along = near / kFan * point();
  for (int i = 0; i < kFan; ++i) casters.push_back({apex, first + double(i) * along, first + (i + 1.0) * along});
  for (tests::Corners& one : casters) {
    for (glm::dvec3& corner : one) corner.y = std::max(corner.y, 0.25 * near);
  }
  tests::add_object(scene, "casters", casters);
  if (far > 0)
    tests::add_object(scene, "far", {{glm::dvec3(-far, -far, -far), glm::dvec3(far, -far, far), glm::dvec3(far)}});
  scene.cameras.push_back(tests::camera({3, 2, 3}, {3, 0, 2.9}, 10));
  return scene;
}

/// Moves the view samples of each block of pixels so that they all see one place of one caster's edge in front of the
/// light.
void look_past_edges(ViewSamples& samples, const SceneFloats& floats, const Light& light, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  constexpr std::uint32_t kBlock = 8;
  const double floor = floats.corners(0)[0].y;
  for (std::uint32_t top = 0; top < samples.height; top += kBlock) {
    for (std::uint32_t left = 0; left < samples.width; left += kBlock) {
      const auto corners =
          floats.corners(2 + static_cast<std::uint32_t>(random() % 2 == 0 ? random() % kFew : kFew + random() % kFan));
      const glm::dvec3 x = glm::mix(glm::dvec3(corners[random() % 2]), glm::dvec3(corners[2]), share(random));
      const glm::dvec2 aim(2 * share(random) - 1, 2 * share(random) - 1);
      const double spread = std::ldexp(1.0, -static_cast<int>(random() % 16));
      for (std::uint32_t i = 0; i < kBlock * kBlock; ++i) {
        const std::size_t pixel = std::size_t{top + i / kBlock} * samples.width + left + i % kBlock;
        const auto [center, u, v] = visibility::light_frame_from(light, glm::vec3(x));
        const glm::dvec3 direction = (light.sun ? center : center - x) + (aim.x + spread * share(random)) * u +
                                     (aim.y + spread * share(random)) * v;
        const glm::dvec3 p = x - (x.y - floor) / direction.y * direction;
        samples.p[pixel] = glm::vec3(p.x, floor, p.z);
      }
    }
  }
}

scenes::LightShape shape_of(int kind, std::mt19937& random) {
  std::uniform_real_distribution<double> real(-1, 1);
  const glm::dvec3 middle(1 + real(random), 5, real(random));
  const glm::dvec3 u(0.5, 0.2 * real(random), 0.1), v(0.1 * real(random), 0.3, 0.5);
  switch (kind) {
    case 0:
      return scenes::Rectangle{middle, u, v - glm::dot(u, v) / glm::dot(u, u) * u};
    case 1:
      return scenes::Disk{middle, {0.2, -1, 0.1}, 0.5};
    case 2:
      return scenes::Sphere{middle, 0.5};
    case 3:
      return scenes::Sun{-middle, 0.53};
    default:
      return scenes::Sun{-middle, 0.03};
  }
}

constexpr std::array kContestants{tests::kViewSample, tests::kNativeViewSample, tests::kEdgeScatter,
                                  tests::kNativeEdgeScatter, tests::kDepthComplexity};

class Contacts : public tests::ExactRows, public testing::WithParamInterface<std::tuple<int, double>> {
 protected:
  static void look(std::uint32_t seed, int rounds);
};

void Contacts::look(std::uint32_t seed, int rounds) {
  const auto [kind, far] = GetParam();
  std::mt19937 random(seed);
  Found found;
  tests::PairCounts pairs;
  for (const double near : {0.1, 0.01, 0.001, 0.0001}) {
    for (int round = 0; round < rounds && !HasFailure(); ++round) {
      scenes::Scene scene = contact(near, far, random);
      scenes::AreaLight lamp;
      lamp.name = "lamp";
      lamp.shape = shape_of(kind, random);
      scene.lights.push_back(lamp);
      SCOPED_TRACE(fmt::format("{} far {} near {} round {}", kind, far, near, round));
      const SceneFloats floats = visibility::make_scene_floats(scene);
      const Light light = visibility::make_light(scene, 0, floats.origin, {64, 0, 0, {}, 0});
      const auto camera = visibility::make_camera(scene.cameras[0], floats.origin, 16, 8);
      ViewSamples samples = visibility::brute_force_view_samples(floats, camera);
      look_past_edges(samples, floats, light, random);
      compare(floats, light, samples, tests::kExactRowsTolerance, found);
      for (const tests::MaskMethod& one : kContestants) {
        if (light.kind != visibility::LightKind::rectangle && one.name != tests::kNativeEdgeScatter.name) continue;
        const auto method = one.make(device(), {});
        EXPECT_TRUE(tests::equals_truth(floats, light, samples, tests::run(*method, floats, light, samples), &pairs))
            << one.name;
      }
    }
  }
  fmt::print("{} view samples, {} partly lit, {} unproven, off by {:.1e} at most; {} pairs, {} visible, {} blocked\n",
             found.pixels, found.partly, found.unproven, found.largest, pairs.pairs, pairs.visible, pairs.blocked);
  EXPECT_EQ(found.wrong, 0U);
  EXPECT_GT(found.partly, found.pixels / 8);
  EXPECT_GT(pairs.visible, pairs.pairs / 20);
  EXPECT_GT(pairs.blocked, pairs.pairs / 20);
}

TEST_P(Contacts, AreTheExactBitsAndAreas) {
  look(11, std::get<0>(GetParam()) == 0 ? 2 : 5);
}
/// Tests 4,000 clusters of view samples for each kind of light.
TEST_P(Contacts, AreTheExactBitsAndAreasFull) {
  look(12, 500);
}

std::string name_of(const testing::TestParamInfo<std::tuple<int, double>>& it) {
  static constexpr std::array kNames{"rectangle", "disk", "sphere", "sun", "narrow_sun"};
  const auto [kind, far] = it.param;
  return fmt::format("{}_{}", kNames[static_cast<std::size_t>(kind)], far > 0 ? "in_a_large_scene" : "alone");
}
INSTANTIATE_TEST_SUITE_P(Lights, Contacts, testing::Combine(testing::Range(0, 5), testing::Values(0.0, 400.0)),
                         &name_of);

}  // namespace
}  // namespace penumbra::volumes
