// SPDX-License-Identifier: Apache-2.0
// Random cases of the soup fuzzer: every bit of every exact mask method must be the truth, which a judge computes from
// its definition in integers, without any code of the program.

#include "tests/fuzz/soup_methods.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace penumbra {
namespace {

fuzz::SoupFindings check_soups(std::uint32_t first_seed, std::uint32_t count) {
  const render::Device device(render::DeviceOptions{"", false});
  fuzz::SoupMethods methods(device);
  fuzz::SoupFindings all;
  for (std::uint32_t seed = first_seed; seed < first_seed + count; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> bytes(600);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const auto judged = fuzz::read_soup_case(bytes);
    if (!judged) continue;
    const fuzz::SoupFindings found = methods.check(*judged);
    EXPECT_EQ(found.wrong, 0U) << "seed " << seed << ": " << found.first_wrong;
    all += found;
  }
  return all;
}

/// Expects that the cases serve their purpose: most can be made, and both answers are common.
void expect_worth(const fuzz::SoupFindings& found, std::uint32_t count) {
  EXPECT_GT(found.cases, count / 2);
  EXPECT_GT(found.visible, found.pairs / 20);
  EXPECT_LT(found.visible, found.pairs - found.pairs / 20);
  EXPECT_GT(found.answers, 4 * found.pairs);
  EXPECT_LT(found.refusals, found.cases / 10);
  std::printf("%llu cases, %llu pairs (%llu visible), %llu answers, %llu refusals, %llu wrong\n",
              static_cast<unsigned long long>(found.cases), static_cast<unsigned long long>(found.pairs),
              static_cast<unsigned long long>(found.visible), static_cast<unsigned long long>(found.answers),
              static_cast<unsigned long long>(found.refusals), static_cast<unsigned long long>(found.wrong));
}

TEST(AdversarialSoups, EveryBitIsTheTruth) {
  constexpr std::uint32_t kCount = 24;  // few, as a driver on the processor compiles shaders for nearly each of them
  expect_worth(check_soups(0, kCount), kCount);
}

TEST(AdversarialSoups, EveryBitIsTheTruthFull) {
  constexpr std::uint32_t kCount = 3000;
  expect_worth(check_soups(1000, kCount), kCount);
}

}  // namespace
}  // namespace penumbra
