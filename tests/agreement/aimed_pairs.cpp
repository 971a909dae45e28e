// SPDX-License-Identifier: Apache-2.0
// Error bounds, tested where they matter: in these scenes an edge, a vertex or the plane of each caster (Aim) is within
// float rounding of the segment from a view sample to a light sample. Every pair is compared with the exact decision.

#include "tests/agreement/aimed_scene.hpp"
#include "tests/agreement/mask_methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace penumbra {
namespace {

using tests::Aim;

class AimedPairs : public tests::DeviceTest, public testing::WithParamInterface<std::tuple<Aim, tests::MaskMethod>> {
 protected:
  static void look(std::uint32_t first, std::uint32_t count,
                   const visibility::SampleRequest& request = tests::AimedScene::kInRows) {
    const auto& [aim, under_test] = GetParam();
    const auto method = under_test.make(device(), {});
    tests::PairCounts counts;
    std::uint64_t open = 0;
    double used = 0;
    for (std::uint32_t seed = first; seed < first + count && !HasFailure(); ++seed) {
      const tests::AimedScene scene(aim, seed, request);
      used = std::max(used, scene.used);
      const visibility::Light light = under_test.no_rows ? tests::scattered(scene.light, false) : scene.light;
      const tests::Masks masks = tests::run(*method, scene.floats, light, scene.samples);
      EXPECT_TRUE(equals_truth(scene.floats, light, scene.samples, masks, &counts)) << "seed " << seed;
      const auto counters = method->counters();
      for (const char* name : {"openPairs", "openQuestions", "openPixels", "trianglesTestedCarefully"}) {
        if (const auto found = counters.find(name); found != counters.end()) open += found->second;
      }
    }
    fmt::print("{} {}: {} pairs, {} visible, {} blocked, {} with a zero; {} times something was open\n",
               under_test.name, name_of(aim), counts.pairs, counts.visible, counts.blocked, counts.zero, open);
    if (is_searched(aim)) {
      fmt::print("up to {:.1f} % of the bound is used\n", 100 * used);
      RecordProperty("percent_of_bound", fmt::format("{:.1f}", 100 * used));
      EXPECT_LT(used, 1);
      EXPECT_GT(used, tests::planted_cut(aim)) << "the cut of the bound in planted_faults would not be noticed";
    }
    EXPECT_GT(counts.visible, counts.pairs / 20);
    EXPECT_GT(aim == Aim::horizon ? counts.horizon : counts.blocked, counts.pairs / 100);
    // Some of the pairs aimed at within rounding must have been uncertain. (View-sample on vector units does not count
    // the light samples that it decides in double.)
    EXPECT_TRUE(open > 0 || under_test.make == tests::kNativeViewSample.make);
  }
  [[nodiscard]] static bool is_searched(Aim aim) {
    return std::find(tests::kSearchedAims.begin(), tests::kSearchedAims.end(), aim) != tests::kSearchedAims.end();
  }
};

TEST_P(AimedPairs, EveryPairIsTheExactDecision) {
  look(0, std::get<1>(GetParam()).on_device() ? 24 : 100);
}
TEST_P(AimedPairs, ThousandsFull) {
  for (std::uint32_t first = 1000; first < 4000 && !HasFailure(); first += 500) look(first, 500);
}
/// Light samples in straight columns, at the sides of tiles, with rows of several tiles each.
using AimedTiles = AimedPairs;
TEST_P(AimedTiles, EveryPairIsTheExactDecision) {
  look(0, 12, {400, 20, 20, visibility::SamplePattern::grid, 0});
}
TEST_P(AimedTiles, ThousandsFull) {
  for (std::uint32_t first = 1000; first < 2000 && !HasFailure(); first += 100)
    look(first, 100, {1024, 32, 32, visibility::SamplePattern::grid, 0});
}
std::string name_of_aim(const testing::TestParamInfo<std::tuple<Aim, tests::MaskMethod>>& info) {
  return fmt::format("{}_{}", std::get<1>(info.param).name, name_of(std::get<0>(info.param)));
}
INSTANTIATE_TEST_SUITE_P(At, AimedPairs,
                         testing::Combine(testing::ValuesIn(tests::kAims), testing::ValuesIn(tests::kAllMaskMethods)),
                         name_of_aim);
INSTANTIATE_TEST_SUITE_P(Searched, AimedPairs,
                         testing::Combine(testing::Values(Aim::beside),
                                          testing::Values(tests::kEdgeScatter, tests::kEdgeScatterPoints)),
                         name_of_aim);

INSTANTIATE_TEST_SUITE_P(At, AimedTiles,
                         testing::Combine(testing::Values(Aim::edge, Aim::aligned, Aim::corner, Aim::left, Aim::vertex,
                                                          Aim::row, Aim::sliver, Aim::grazing),
                                          testing::Values(tests::kEdgeScatterPoints, tests::kNativeEdgeScatterPoints)),
                         name_of_aim);

}  // namespace
}  // namespace penumbra
