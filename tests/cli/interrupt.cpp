// SPDX-License-Identifier: Apache-2.0
// Tests Ctrl-C at any moment: exit code 130 soon after it, and nothing left behind.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>

#include <chrono>

namespace penumbra::tests {
namespace {

using testing::ElementsAre;

class Interrupt : public ProgramTest, public testing::WithParamInterface<double> {};

TEST_P(Interrupt, EndsWith130AndLeavesNoFile) {
  const std::string scene = tiny_scene();
  // Enough work for minutes, so that the signal always arrives during it.
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome =
      run_program({.arguments = {"render", scene, "-o", path("out.exr"), "--bits", path("out.bits"), "--method",
                                 "raytrace", "--size", "2048x2048", "--light-samples", "4096"},
                   .environment = {},
                   .interrupt_after = GetParam()});
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_LT(elapsed, GetParam() + 20) << "an interrupt should not wait for the end of the work";
  EXPECT_THAT(outcome.err, testing::HasSubstr("interrupted"));
  EXPECT_THAT(files(), ElementsAre("scene.json"));
}

INSTANTIATE_TEST_SUITE_P(After, Interrupt, testing::Values(0.15, 0.5, 1.5, 4.0), [](const auto& test) {
  return "Milliseconds" + std::to_string(static_cast<int>(1000 * test.param));
});

}  // namespace
}  // namespace penumbra::tests
