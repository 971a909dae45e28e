// SPDX-License-Identifier: Apache-2.0
// Tests which freed arrays are kept for reuse, and how many.

#include "base/kept_arrays.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <new>
#include <random>
#include <span>
#include <vector>

namespace penumbra {
namespace {

constexpr std::size_t kEighth = KeptArrays::kLeast / 8;

/// Allocates as the program's operator new does.
void* new_or_kept(KeptArrays& arrays, std::size_t bytes) {
  if (void* const kept = arrays.take(bytes)) return kept;
  arrays.settle(bytes, bytes);
  return std::malloc(bytes);
}

TEST(KeptArrays, AreForTheNextOfAboutTheirSize) {
  KeptArrays arrays;
  void* const early = new_or_kept(arrays, 8 * kEighth);
  EXPECT_FALSE(arrays.keep(early, 8 * kEighth)) << "arrays are not kept before keeping is enabled";
  std::free(early);
  arrays.start_keeping();
  void* const small = new_or_kept(arrays, 8 * kEighth);
  void* const large = new_or_kept(arrays, 12 * kEighth);
  EXPECT_TRUE(arrays.keep(large, 12 * kEighth));
  EXPECT_TRUE(arrays.keep(small, 8 * kEighth));
  EXPECT_EQ(arrays.bytes(), 20 * kEighth);
  EXPECT_EQ(arrays.take(8 * kEighth), small) << "the smallest array that is large enough";
  EXPECT_EQ(arrays.take(8 * kEighth), large) << "an array 1.5 times as large may still be used";
  EXPECT_EQ(arrays.bytes(), 0U);
  EXPECT_TRUE(arrays.keep(large, 12 * kEighth));
  EXPECT_EQ(arrays.take(8 * kEighth - 8), nullptr) << "an array more than 1.5 times as large is not used";
  EXPECT_EQ(arrays.bytes(), 0U) << "the kept array is freed: with 16 of 20 eighths in use there is no room for it";
  arrays.settle(8 * kEighth - 8, 0);
  EXPECT_TRUE(arrays.keep(small, 8 * kEighth));
  arrays.free_all();
  EXPECT_EQ(arrays.bytes(), 0U);
}

TEST(KeptArrays, AreWithThoseInUseNoMoreThanWasInUseAtOnce) {
  KeptArrays arrays;
  arrays.start_keeping();
  std::mt19937 random(5);
  std::vector<void*> used;
  std::map<void*, std::size_t> size_of;
  std::size_t in_use = 0, most = 0, taken = 0;
  for (int i = 0; i < 3000; ++i) {
    if (used.size() < 12 && (used.empty() || random() % 2 == 0)) {
      const std::size_t bytes = (8 + random() % 40) * 1000;
      void* first = arrays.take(bytes);
      if (first != nullptr) {
        ++taken;
      } else {
        const std::size_t made = bytes + random() % 500;  // as the C library rounds sizes up
        arrays.settle(bytes, made);
        first = std::malloc(made);
        size_of[first] = made;
      }
      used.push_back(first);
      in_use += size_of[first];
      most = std::max(most, in_use);
    } else {
      std::swap(used.back(), used[random() % used.size()]);
      void* const first = used.back();
      used.pop_back();
      in_use -= size_of[first];
      if (!arrays.keep(first, size_of[first])) std::free(first);
    }
    ASSERT_LE(in_use + arrays.bytes(), most);
  }
  EXPECT_GT(taken, 200U);
  for (void* const first : used) std::free(first);
  arrays.free_all();
}

/// The sum of kept bytes is right again after everything has been given back, whichever threads took arrays in between.
TEST(KeptArrays, MayBeAskedForByAnyThread) {
  KeptArrays arrays;
  arrays.start_keeping();
  constexpr std::size_t kArrays = 20000;
  tbb::parallel_for(std::size_t{0}, kArrays, [&](std::size_t i) {
    const std::size_t bytes = 1800 + i % 200;
    void* first = arrays.take(bytes);
    const bool is_new = first == nullptr;
    if (is_new) first = std::malloc(2000);
    if (is_new) arrays.settle(bytes, 2000);
    std::memset(first, static_cast<int>(i), 2000);  // no other thread has it
    ASSERT_TRUE(std::ranges::all_of(std::span(static_cast<unsigned char*>(first), 2000),
                                    [&](unsigned char x) { return x == static_cast<unsigned char>(i); }));
    if (!arrays.keep(first, 2000)) std::free(first);
    if (i % 1000 == 0) arrays.free_all();
  });
  arrays.free_all();
  EXPECT_EQ(arrays.bytes(), 0U);
}

#ifndef PENUMBRA_SHADOW_MEMORY  // a build with it brings its own operator new
TEST(KeptArrays, AreThoseOfEveryList) {
  kept_arrays().start_keeping();
  std::vector<char> list(KeptArrays::kLeast);
  const auto first = reinterpret_cast<std::uintptr_t>(list.data());
  list = std::vector<char>();
  EXPECT_GE(kept_arrays().bytes(), KeptArrays::kLeast);
  const std::vector<char> again(KeptArrays::kLeast);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(again.data()), first);
  EXPECT_TRUE(std::ranges::all_of(again, [](char x) { return x == 0; }));
  list = std::vector<char>(2 * KeptArrays::kLeast);
  list = std::vector<char>();
  EXPECT_GT(kept_arrays().bytes(), 0U);
  EXPECT_THROW(static_cast<void>(::operator new(SIZE_MAX / 2)), std::bad_alloc);
  EXPECT_EQ(kept_arrays().bytes(), 0U) << "kept arrays must be freed before bad_alloc is thrown";
}
#endif

}  // namespace
}  // namespace penumbra
