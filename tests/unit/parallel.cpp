// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace penumbra::mesh {
namespace {

TEST(EqualOnAllCores, SeesWhatDiffersWhereverItIs) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{100'003}}) {
    std::vector<std::uint32_t> one(count);
    std::iota(one.begin(), one.end(), 0U);
    std::vector<std::uint32_t> other = one;
    EXPECT_TRUE(equal_on_all_cores(one, other));
    other.push_back(0);
    EXPECT_FALSE(equal_on_all_cores(one, other)) << "one is longer";
    other.pop_back();
    for (std::size_t i = 0; i < count; i += 1 + count / 7) {
      ++other[i];
      EXPECT_FALSE(equal_on_all_cores(one, other)) << i;
      --other[i];
    }
    if (count == 0) continue;
    ++other.back();
    EXPECT_FALSE(equal_on_all_cores(one, other)) << "the last";
  }
}

}  // namespace
}  // namespace penumbra::mesh
