// SPDX-License-Identifier: Apache-2.0
// Tests plateaus against closed forms, against the minimum over many places along each edge, and against its C++ twin.

#include "tests/agreement/volumes/soft_stage.hpp"

#include "volumes/raster/light_volumes.hpp"
#include "volumes/soft/methods.hpp"
#include "volumes/soft/outer_penumbra.hpp"

#include <numbers>
#include <random>

namespace penumbra::volumes {
namespace {

using tests::Errors;
using tests::SoftStage;

class Plateaus : public tests::DeviceTest {
 protected:
  static std::vector<double> twin(const SoftStage& stage) {
    const std::vector<float> hard = stage.run(*make_hard_volume(device(), {}));
    const ShadowCasters casters(stage.floats);
    const glm::vec3 center = visibility::center_of(stage.light);
    const LightVolumes volumes = casters.seen_from(center, stage.light);
    const OuterPenumbra penumbra{glm::dvec3(center), std::sqrt(stage.light.area / std::numbers::pi)};
    return stage.at_judged([&](std::size_t i) {
      if (hard[i] == 0) return 0.0;
      const auto [a, b, c] = stage.floats.corners(static_cast<std::uint32_t>(stage.samples.triangle[i]));
      const glm::dvec3 n = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
      double deepest = 0;
      for (const VolumeEdge& edge : volumes.edges) {
        deepest = std::max(deepest, penumbra.depth_at(glm::dvec3(stage.samples.p[i]), n, edge.a, edge.b));
      }
      return 1 - hidden_at(deepest);
    });
  }
};

/// A square over a floor: around its shadow, V depends on the distance from it, divided by the radius of a vertex's
/// disk.
TEST_F(Plateaus, ASquareHasARimOfOneWidth) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  tests::add_object(scene, "board", tests::quad({0, 2, 0}, {0.5, 0, 0}, {0, 0, -0.5}));
  scene.lights.push_back(tests::ceiling_light(4, 0.5));
  scene.cameras.push_back(tests::camera({0, 1.5, 0}, {0, 0, 0}, 120));
  scene.cameras.back().up = {0, 0, -1};
  const SoftStage stage(scene, device(), 48, 48);
  const std::vector<float> found = stage.run(*make_plateaus(device(), {}));
  const double reach =
      std::sqrt(1 / std::numbers::pi) * 2 / (4 - 2);  // from the light's radius, in proportion to heights
  std::size_t in_rim = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!stage.judged(i)) continue;
    const glm::dvec3 p = glm::dvec3(stage.samples.p[i]) + stage.floats.origin;
    const double x = std::max(std::abs(p.x) - 1, 0.0), z = std::max(std::abs(p.z) - 1, 0.0), off = std::hypot(x, z);
    if (std::abs(p.y) > 1e-3 || (off == 0 && std::max(std::abs(p.x), std::abs(p.z)) > 1 - 1e-5)) continue;
    const double tau = std::clamp(1 - off / reach, 0.0, 1.0);
    ASSERT_NEAR(found[i], 1 - tau * tau * (3 - 2 * tau), 2e-5) << "pixel " << i;
    in_rim += off > 0 && off < reach ? 1 : 0;
  }
  EXPECT_GT(in_rim, 100U);
}

/// The place of an edge that gives the deepest shadow, between ends with disks of different sizes, is the best of many
/// places.
TEST_F(Plateaus, TheDeepestPlaceOfAnEdgeIsFound) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-1.5, 1.5), height(-0.5, 3.5);
  std::size_t deep = 0;
  for (int i = 0; i < 400; ++i) {
    const OuterPenumbra penumbra{{0.1, 3, -0.2}, 0.4};
    const glm::dvec3 a(place(random), height(random), place(random)), b(place(random), height(random), place(random)),
        p(place(random), 0, place(random));
    double best = 0;
    for (int k = 0; k <= 20000; ++k) {
      const glm::dvec3 x = a + k / 20000.0 * (b - a);
      if (!(x.y > 0 && x.y < 3 * (1 - 1e-6))) continue;
      const glm::dvec3 shadow = penumbra.center + (x - penumbra.center) * (3 / (3 - x.y));
      best = std::max(best, 1 - glm::length(shadow - p) / (penumbra.radius * x.y / (3 - x.y)));
    }
    const double found = penumbra.depth_at(p, {0, 1, 0}, a, b);
    EXPECT_LE(best, found + 1e-9) << i;
    EXPECT_NEAR(found, best, 2e-3) << i;
    deep += best > 0.05 ? 1 : 0;
  }
  EXPECT_GT(deep, 40U);
}

TEST_F(Plateaus, IsItsTwin) {
  for (const char* name : {"parallel-square", "fusion", "room"}) {
    const SoftStage stage(tests::shipped_scene(name), device(), 40, 30);
    const auto method = make_plateaus(device(), {});
    const std::vector<float> found = stage.run(*method);
    const Errors errors = tests::errors_of(found, twin(stage));
    fmt::print("{}: {} pixels, {} in penumbra, off by {:.1e} at most\n", name, errors.pixels, errors.penumbra,
               errors.largest);
    EXPECT_LE(errors.largest, 1e-7) << name;
    EXPECT_GT(errors.penumbra, 10U) << name;
    EXPECT_EQ(stage.run(*method, 5), found) << name << " in tiles";
  }
}

/// The method widens the umbra to that of a hard shadow, so most of its wrong pixels are too dark.
TEST_F(Plateaus, UmbraeAreTooLarge) {
  for (const char* name : {"parallel-square", "contact", "fusion"}) {
    const SoftStage stage(tests::shipped_scene(name), device(), 48, 36);
    const std::vector<double> exact = stage.exact();
    const std::vector<float> found = stage.run(*make_plateaus(device(), {}));
    double sum = 0;
    std::size_t dark = 0, umbra = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      if (std::isnan(exact[i])) continue;
      sum += found[i] - exact[i];
      dark += found[i] == 0 ? 1 : 0;
      umbra += exact[i] == 0 ? 1 : 0;
    }
    fmt::print("{}: {} pixels black, {} in umbra, summed error {:.1f}\n", name, dark, umbra, sum);
    EXPECT_LT(sum, 0) << name;
    EXPECT_GT(dark, umbra) << name;
  }
}

TEST_F(Plateaus, RefusesWhatItCannotDo) {
  EXPECT_THROW(static_cast<void>(make_plateaus(device(), {{"split", "2"}})), UsageError);
  scenes::Scene scene = tests::floor_and_light(1);
  scene.lights[0].shape = scenes::Sphere{{0, 4, 0}, 1};
  EXPECT_THROW(static_cast<void>(SoftStage(scene, device(), 8, 8).run(*make_plateaus(device(), {}))), InputError);
}

}  // namespace
}  // namespace penumbra::volumes
