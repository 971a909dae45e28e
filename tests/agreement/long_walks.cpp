// SPDX-License-Identifier: Apache-2.0
// Tests scenes so dense between the view samples and the light that one block of pixels visits more of a hierarchy than
// the loops of some drivers allow (65,535 iterations for a workgroup): every engine finishes, with the same bits.

#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/support.hpp"
#include "volumes/counters/methods.hpp"

namespace penumbra {
namespace {

using LongWalks = tests::DeviceTest;

/// Returns `count` small triangles without neighbours: each edge is a silhouette from everywhere, so that no edge can
/// be skipped.
scenes::Scene swarm_over_floor(int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> real(-1, 1);
  const auto point = [&](double size) { return size * glm::dvec3(real(random), real(random), real(random)); };
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, -1, 0}, {4, 0, 0}, {0, 0, -4}));
  std::vector<tests::Corners> swarm;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 at = glm::dvec3(0, 1.5, 0) + point(0.5);
    swarm.push_back({at + point(0.002), at + point(0.002), at + point(0.002)});
  }
  tests::add_object(scene, "swarm", swarm);
  scene.lights.push_back(tests::ceiling_light(4, 3));
  scene.cameras.push_back(tests::camera({0, 0.5, 0}, {0, -1, 0}, 60));
  scene.cameras[0].up = {0, 0, 1};
  return scene;
}

/// Expects the bits that the processor's own walk finds; returns how often the method had to start again.
std::uint64_t expect_same_bits(visibility::Method& method, const tests::Stage& stage, const tests::Masks& expected) {
  const tests::Masks masks = tests::run(method, stage.floats, stage.light, stage.samples);
  EXPECT_EQ(tests::differing_bits(masks, expected), 0U) << method.description().name;
  const auto counters = method.counters();
  const auto count = [&](const char* name) { return counters.contains(name) ? counters.at(name) : 0; };
  return count("listRetries") + count("loopRetries");
}

class LongWalk {
 public:
  /// `rows`: the light has `rows` × `rows` samples.
  LongWalk(const render::Device& device, int triangles, std::uint32_t rows = 4)
      : stage(swarm_over_floor(triangles), 8, 8, {rows * rows, rows, rows, visibility::SamplePattern::rows, 0}),
        expected(tests::run(*tests::kNativeViewSample.make(device, {}), stage.floats, stage.light, stage.samples)) {
    std::size_t part = 0;
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      part += expected.visible_count(i) > 0 && expected.visible_count(i) < stage.light.sample_count() ? 1 : 0;
    }
    EXPECT_GT(part, stage.samples.size() / 4);
  }

  tests::Stage stage;
  tests::Masks expected;
};

TEST_F(LongWalks, OverEdgesEndWithTheSameBits) {
  const LongWalk walk(device(), 250'000);
  const std::uint64_t scattered = expect_same_bits(*tests::kEdgeScatter.make(device(), {}), walk.stage, walk.expected);
  const std::uint64_t counted =
      expect_same_bits(*tests::kDepthComplexity.make(device(), {}), walk.stage, walk.expected);
  if (device().info().name.starts_with("llvmpipe")) {
    EXPECT_GT(scattered, 0U) << "this driver's loop limit was not reached: the test needs more triangles";
    EXPECT_GT(counted, 0U);
  }
}

// The driver's loop limit is reached while edges are counted at light samples, not in a hierarchy: whole pixels are
// left to the host.
TEST_F(LongWalks, OverLightSamplesEndWithTheSameBits) {
  const LongWalk walk(device(), 4'000, 32);
  const auto method = tests::kDepthComplexity.make(device(), {});
  expect_same_bits(*method, walk.stage, walk.expected);
  if (device().info().name.starts_with("llvmpipe")) {
    EXPECT_GT(method->counters().at("openPairs"), 1024U * walk.stage.samples.size() / 2)
        << "this driver's loop limit was not reached: the test needs more triangles";
  }
}

TEST_F(LongWalks, OverTrianglesEndWithTheSameBitsFull) {
  const LongWalk walk(device(), 3'000'000);
  const std::uint64_t mapped = expect_same_bits(*tests::kViewSample.make(device(), {}), walk.stage, walk.expected);
  if (device().info().name.starts_with("llvmpipe")) {
    EXPECT_GT(mapped, 0U) << "this driver's loop limit was not reached: the test needs more triangles";
  }
}

}  // namespace
}  // namespace penumbra
