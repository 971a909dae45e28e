// SPDX-License-Identifier: Apache-2.0
// Tests stacks with so many layers between view samples and light that a count in one byte would overflow to 0.

#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/support.hpp"

namespace penumbra {
namespace {

using DeepStacks = tests::DeviceTest;

/// Returns thin boxes, one above the other, over half of a floor; all end at x = 0.
scenes::Scene stack_over_floor(int boxes) {
  scenes::Scene scene;
  tests::add_object(scene, "floor", tests::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}));
  std::vector<tests::Corners> stack;
  for (int i = 0; i < boxes; ++i) {
    const double y = 1 + 0.01 * i;
    for (const double turn : {1.0, -1.0}) {  // above and below, in front and behind, right and left
      const glm::dvec3 middle(-2, y, 0);
      for (const auto& [out, along, across] :
           {std::array<glm::dvec3, 3>{glm::dvec3(0, 0.002, 0), {2, 0, 0}, {0, 0, -3}},
            std::array<glm::dvec3, 3>{glm::dvec3(0, 0, 3), {2, 0, 0}, {0, 0.002, 0}},
            std::array<glm::dvec3, 3>{glm::dvec3(2, 0, 0), {0, 0, -3}, {0, 0.002, 0}}}) {
        const auto side = tests::quad(middle + turn * out, turn * along, across);
        stack.insert(stack.end(), side.begin(), side.end());
      }
    }
  }
  tests::add_object(scene, "stack", stack);
  scene.lights.push_back(tests::ceiling_light(4, 1));
  scene.cameras.push_back(tests::camera({1.5, 0.8, 0}, {-0.5, 0, 0}, 60));
  return scene;
}

TEST_F(DeepStacks, HideWhatTheyHide) {
  std::size_t deep = 0;
  for (const int boxes : {63, 64, 65, 126, 127, 128, 129, 130, 256, 257}) {
    const tests::Stage stage(stack_over_floor(boxes), 12, 12, {256, 16, 16, visibility::SamplePattern::rows, 0});
    const tests::Masks expected =
        tests::run(*tests::kNativeViewSample.make(device(), {}), stage.floats, stage.light, stage.samples);
    for (const auto& method : {tests::kNativeEdgeScatter, tests::kEdgeScatter, tests::kNativeEdgeScatterPoints}) {
      const tests::Masks masks = tests::run(*method.make(device(), {}), stage.floats, stage.light, stage.samples);
      EXPECT_EQ(tests::differing_bits(masks, expected), 0U) << method << ", " << boxes << " boxes";
    }
    for (std::size_t i = 0; i < stage.samples.size(); ++i) {
      deep += expected.visible_count(i) > 0 && expected.visible_count(i) < stage.light.sample_count() ? 1 : 0;
    }
  }
  EXPECT_GT(deep, 300U) << "view samples that see a part of the light";
}

}  // namespace
}  // namespace penumbra
