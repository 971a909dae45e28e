// SPDX-License-Identifier: Apache-2.0
// Sorting in linear time on all cores, compared with std::stable_sort and with a search from the front.

#include "base/buckets.hpp"

#include "base/pages.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>
#include <random>

namespace penumbra {
namespace {

std::vector<std::uint32_t> random_words(std::size_t count, std::uint32_t most) {
  std::mt19937 random(static_cast<std::uint32_t>(count));
  std::uniform_int_distribution<std::uint32_t> word(0, most);
  std::vector<std::uint32_t> words(count);
  for (std::uint32_t& one : words) one = word(random);
  return words;
}

TEST(Parts, HoldTheirElementsInAscendingOrder) {
  for (const std::size_t count : {0U, 1U, 16384U, 16385U, 100000U}) {
    const std::vector<std::uint32_t> words = random_words(count, 1023);
    const Parts parts = into_parts(count, 16, 6, [&](std::size_t i) { return words[i]; });
    ASSERT_EQ(parts.size(), 16U);
    std::size_t all = 0;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      std::uint32_t next = 0;
      for (const auto [word, number] : parts[part]) {
        EXPECT_EQ(word >> 6U, part);
        EXPECT_EQ(word, words[number]);
        EXPECT_GE(number, next) << "ascending";
        next = number + 1;
        ++all;
      }
    }
    EXPECT_EQ(all, count);
  }
}

TEST(Parts, AreAPowerOfTwoAndNotTooMany) {
  for (const std::size_t count : {0U, 1U, 4096U, 8192U, 8193U, 1U << 30U}) {
    EXPECT_TRUE(std::has_single_bit(Parts::good_count(count)));
    EXPECT_LE(Parts::good_count(count), 4096U);
  }
  EXPECT_EQ(Parts::good_count(1000), 1U);
}

TEST(Buckets, AreThoseOfAStableSort) {
  for (const std::size_t count : {0U, 1U, 5000U, 200000U}) {
    for (const std::uint32_t buckets : {1U, 7U, 5000U, 300000U}) {
      const std::vector<std::uint32_t> of = random_words(count, buckets - 1);
      Buckets made = into_buckets(count, buckets, [&](std::size_t i) { return of[i]; });
      UnsetList<std::uint32_t> sorted(count);
      std::iota(sorted.begin(), sorted.end(), 0U);
      std::ranges::stable_sort(sorted, {}, [&](std::uint32_t i) { return of[i]; });
      EXPECT_EQ(made.items, sorted);
      ASSERT_EQ(made.size(), buckets);
      for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
        for (const std::uint32_t number : made[bucket]) EXPECT_EQ(of[number], bucket);
      }
    }
  }
  EXPECT_EQ(into_buckets(0, 0, [](std::size_t) { return 0U; }).size(), 0U);
}

TEST(FirstOfSame, IsTheFirstWhateverTheHashesAre) {
  for (const std::size_t count : {0U, 1U, 300U, 100000U}) {
    const std::vector<std::uint32_t> words = random_words(count, static_cast<std::uint32_t>(count) / 3);
    std::vector<std::uint32_t> expected(count), first(count + 1, 0xffffffffU);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (first[words[i]] == 0xffffffffU) first[words[i]] = i;
      expected[i] = first[words[i]];
    }
    const auto same = [&](std::size_t i, std::size_t j) { return words[i] == words[j]; };
    const auto good = [&](std::size_t i) { return (words[i] + 1) * 0x9e3779b97f4a7c15U; };
    EXPECT_EQ(first_of_same(count, good, same), expected);
    if (count > 300) continue;
    const auto poor = [&](std::size_t i) { return std::uint64_t{words[i] % 2} << 40U; };  // most hashes collide
    EXPECT_EQ(first_of_same(count, poor, same), expected);
  }
}

TEST(Buckets, AreTheSameForAnyNumberOfThreads) {
  const std::vector<std::uint32_t> of = random_words(150000, 999);
  const auto make = [&] { return into_buckets(of.size(), 1000, [&](std::size_t i) { return of[i]; }); };
  const Buckets many = make();
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Buckets one = make();
  EXPECT_EQ(one.first, many.first);
  EXPECT_EQ(one.items, many.items);
}

TEST(Pages, ListsHaveTheirSizeAndHoldZeros) {
  for (const std::size_t count : {0U, 1U, 5000U, 3000000U}) {  // the last one needs several pieces of pages
    std::vector<std::uint32_t> list;
    resize_on_all_cores(list, count);
    ASSERT_EQ(list.size(), count);
    EXPECT_TRUE(std::ranges::all_of(list, [](std::uint32_t x) { return x == 0; }));
  }
  struct Big {
    std::array<double, 40> values{1.0};  // not a divisor of a page's size
  };
  std::vector<Big> list;
  resize_on_all_cores(list, 40000);
  ASSERT_EQ(list.size(), 40000U);
  EXPECT_TRUE(std::ranges::all_of(list, [](const Big& x) { return x.values[0] == 1 && x.values[39] == 0; }));
}

TEST(Pages, UninitialisedListsKeepWhatIsWritten) {
  for (const std::size_t count : {1U, 5000U, 3000000U}) {
    UnsetList<std::uint32_t> list;
    list.resize(count);
    for (std::size_t i = 0; i < count; ++i) list[i] = static_cast<std::uint32_t>(i * 7);
    list.resize(2 * count);  // moves the list
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(list[i], static_cast<std::uint32_t>(i * 7));
    const UnsetList<std::uint32_t> copy = list, two = {3, 4}, filled(count, 9U);
    EXPECT_TRUE(std::ranges::equal(std::span(copy).first(count), std::span(list).first(count)));
    EXPECT_EQ(two[1], 4U);
    EXPECT_TRUE(std::ranges::all_of(filled, [](std::uint32_t x) { return x == 9; }));
  }
  UnsetList<std::uint32_t> list;
  EXPECT_THROW(list.resize(SIZE_MAX / 8), std::exception);
}

#ifndef PENUMBRA_SHADOW_MEMORY  // a build with it brings its own operator new
TEST(Pages, LargeArraysOfAnyListBeginAtALargePage) {
  for (const std::size_t bytes : {kLargeArray, kLargeArray + 1, 17 * kLargeArray + 5}) {
    const std::vector<char> list(bytes, 'x');
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(list.data()) % kLargePage, 0U);
    EXPECT_TRUE(std::ranges::all_of(list, [](char x) { return x == 'x'; }));
    UnsetList<std::uint16_t> unset(bytes / 2);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(unset.data()) % kLargePage, 0U);
    struct alignas(64) Line {
      char x;
    };
    const std::vector<Line> lines(bytes / sizeof(Line) + 1);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(lines.data()) % kLargePage, 0U);
  }
  EXPECT_THROW(static_cast<void>(::operator new(SIZE_MAX / 2)), std::bad_alloc);
}
#endif

}  // namespace
}  // namespace penumbra
