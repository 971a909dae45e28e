// SPDX-License-Identifier: Apache-2.0
// Compares one picture on every vector unit that this processor has: the bits are the same, so that a test on one unit
// holds for all.

#include "tests/agreement/mask_methods.hpp"
#include "tests/agreement/support.hpp"
#include "tests/agreement/volumes/exact_rows.hpp"
#include "tests/unit/shipped_scene.hpp"

#include <hwy/targets.h>

#include <algorithm>
#include <bit>
#include <cstdint>

namespace penumbra {
namespace {

/// Restricts the program to one of the processor's vector units.
class OnlyTarget {
 public:
  explicit OnlyTarget(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  OnlyTarget(const OnlyTarget&) = delete;
  OnlyTarget& operator=(const OnlyTarget&) = delete;
  ~OnlyTarget() { hwy::SetSupportedTargetsForTest(0); }
};

class EveryWidth : public tests::DeviceTest, public testing::WithParamInterface<const char*> {};

scenes::Scene scene_under(const std::string& kind) {
  scenes::Scene scene = tests::shipped_scene("large-penumbra");
  const auto center = std::get<scenes::Rectangle>(scene.lights.front().shape).center;
  if (kind == "disk") scene.lights.front().shape = scenes::Disk{center, {0, -1, 0}, 3};
  if (kind == "sphere") scene.lights.front().shape = scenes::Sphere{center, 3};  // the sphere contains casters
  return scene;
}

TEST_P(EveryWidth, HasTheSameMasks) {
  const scenes::Scene scene = scene_under(GetParam());
  for (const auto pattern : {visibility::SamplePattern::rows, visibility::SamplePattern::sobol}) {
    const tests::Stage stage(scene, 24, 24, {200, 0, 0, pattern, 0});
    for (const auto& method : {tests::kNativeEdgeScatter, tests::kNativeViewSample, tests::kNativeDepthComplexity}) {
      const auto masks_on = [&](std::int64_t target) {
        const OnlyTarget only(target);
        return tests::run(*method.make(device(), {}), stage.floats, stage.light, stage.samples);
      };
      std::int64_t targets = hwy::SupportedTargets();
      const tests::Masks expected = masks_on(targets);
      for (; targets != 0; targets &= targets - 1) {
        const std::int64_t target = targets & -targets;
        EXPECT_EQ(tests::differing_bits(masks_on(target), expected), 0U)
            << method << ", " << name_of(pattern) << ", " << hwy::TargetName(target);
      }
    }
  }
}

TEST_P(EveryWidth, HasTheSameExactAreas) {
  const tests::Stage stage(scene_under(GetParam()), 24, 24, {});
  const auto answer_on = [&](std::int64_t target) {
    const OnlyTarget only(target);
    const auto method = volumes::make_edge_scatter(device(), {{"rows", "exact"}});
    method->want_form_factors(true);
    return tests::run_exact_rows(*method, stage.floats, stage.light, stage.samples);
  };
  std::int64_t targets = hwy::SupportedTargets();
  const tests::RowsAnswer expected = answer_on(targets);
  EXPECT_GT(std::ranges::count_if(expected.shares, [](float share) { return share > 0 && share < 1; }), 100);
  for (; targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    const tests::RowsAnswer found = answer_on(target);
    EXPECT_EQ(found.shares, expected.shares) << hwy::TargetName(target);
    EXPECT_EQ(found.form_factors, expected.form_factors) << hwy::TargetName(target);
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, EveryWidth, testing::Values("rectangle", "disk", "sphere"),
                         [](const auto& given) { return std::string(given.param); });

}  // namespace
}  // namespace penumbra
