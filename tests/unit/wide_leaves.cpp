// SPDX-License-Identifier: Apache-2.0
// Tests leaves of hierarchies that are made when first needed.

#include "engines/vectors/wide_leaves.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace penumbra::vectors {
namespace {

struct Leaf {
  std::uint64_t value = 0;
};
using Leaves = WideLeaves<Leaf>;
constexpr std::size_t kFew = 1000, kMany = 100'003;

std::uint64_t value_of(std::size_t number) {
  return 3 * number + 1;
}

TEST(WideLeaves, OfFewAreMadeAtOnceAndOfManyWhenAskedFor) {
  for (const std::size_t count : {std::size_t{0}, kFew, kMany}) {
    std::atomic<std::size_t> made = 0;
    Leaves leaves;
    leaves.make(count, [&](std::size_t number, Leaf& leaf) {
      ++made;
      leaf.value += value_of(number);
    });
    EXPECT_EQ(leaves.size(), count);
    for (std::size_t i = 0; i <= count; ++i) leaves.fetch(i);
    EXPECT_EQ(made, count == kMany ? 0 : count) << "prefetching must not make leaves";
    if (count == 0) continue;
    EXPECT_EQ(std::as_const(leaves)[count - 1].value, value_of(count - 1));
    EXPECT_LT(made, count == kMany ? 100 : count + 1) << "only the leaf's own block may be made";
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(leaves[i].value, value_of(i));
    EXPECT_EQ(made, count) << "each leaf must be made exactly once";
  }
}

TEST(WideLeaves, AreTheSameForAllThreadsThatAsk) {
  for (int round = 0; round < 20; ++round) {
    Leaves leaves;
    leaves.make(kMany, [&](std::size_t number, Leaf& leaf) { leaf.value += value_of(number); });
    std::vector<std::atomic<const Leaf*>> seen(kMany);
    // At any time all threads work in the same few blocks.
    for_each_index(4 * kMany, [&](std::size_t i) {
      const std::size_t number = i / 4;
      leaves.fetch((number + 40) % kMany);
      const Leaf& leaf = leaves[number];
      ASSERT_EQ(leaf.value, value_of(number));
      const Leaf* const before = seen[number].exchange(&leaf);
      ASSERT_TRUE(before == nullptr || before == &leaf);
    });
  }
}

TEST(WideLeaves, TakeOthersAndForgetThem) {
  Leaves some;
  some.make(kFew, [](std::size_t number, Leaf& leaf) { leaf.value = value_of(number); });
  for (const std::size_t count : {kFew, kMany}) {
    Leaves leaves;
    leaves.make(count, [](std::size_t, Leaf& leaf) { leaf.value = 7; });
    leaves.append(some);
    ASSERT_EQ(leaves.size(), count + kFew);
    EXPECT_EQ(leaves[count - 1].value, 7U);
    EXPECT_EQ(leaves[count].value, value_of(0));
    EXPECT_EQ(leaves[count + kFew - 1].value, value_of(kFew - 1));
    leaves.forget_appended();
    EXPECT_EQ(leaves.size(), count);
  }
}

TEST(WideLeaves, OfACopyAreItsOwn) {
  for (const std::size_t count : {kFew, kMany}) {
    const auto held = std::make_shared<std::uint64_t>(7);
    Leaves leaves;
    leaves.make(count, [held](std::size_t, Leaf& leaf) { leaf.value = *held; });
    leaves[0].value = 8;
    Leaves copy = leaves;
    EXPECT_EQ(copy[0].value, 8U);
    copy[0].value = 9;
    EXPECT_EQ(leaves[0].value, 8U);
    leaves = {};
    EXPECT_EQ(leaves.size(), 0U);
    EXPECT_EQ(copy[0].value, 9U);
    EXPECT_EQ(copy[count - 1].value, 7U) << "the copy must make its leaves from its own data";
    const Leaves moved = std::move(copy);
    EXPECT_EQ(moved[0].value, 9U);
    EXPECT_EQ(moved[count - 1].value, 7U);
  }
}

}  // namespace
}  // namespace penumbra::vectors
