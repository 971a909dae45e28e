// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

/// Guards against our compiler. g++ 12 at -O2 (its SLP vectoriser) removes two neighbouring double → float → double
/// conversions together with their rounding, sometimes even where the floats are stored in between. Scene floats and p
/// are defined by that rounding, so the build passes -fno-tree-slp-vectorize; this test fails if the flag is lost.
namespace penumbra::test {
namespace {

struct Pair {
  double x, y;
};

[[gnu::noinline]] Pair round_to_float(const Pair& pair) {
  return {static_cast<double>(static_cast<float>(pair.x)), static_cast<double>(static_cast<float>(pair.y))};
}

TEST(FloatRounding, SurvivesTheOptimiser) {
  volatile double tenth = 0.1;  // unknown to the optimiser
  const Pair rounded = round_to_float({tenth, 2 * tenth});
  EXPECT_EQ(rounded.x, 0x1.99999ap-4);
  EXPECT_EQ(rounded.y, 0x1.99999ap-3);
}

}  // namespace
}  // namespace penumbra::test
