// SPDX-License-Identifier: Apache-2.0
// Compares sets of triangles with those of the standard library.

#include "visibility/seen/triangle_bits.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

namespace penumbra::visibility {
namespace {

std::vector<std::uint64_t> bits_of(const TriangleBits& bits, std::uint64_t first, std::uint64_t end) {
  std::vector<std::uint64_t> all;
  bits.for_each(first, end, [&](std::uint64_t bit) { all.push_back(bit); });
  return all;
}

TEST(TriangleBits, AreThoseThatAnyThreadSet) {
  constexpr std::uint64_t kTriangles = 50'000;  // several pages, the last of them incomplete
  std::mt19937_64 random(3);
  std::vector<std::uint64_t> wanted{0, 63, 64, 4095, 4096, kTriangles - 1};
  for (int i = 0; i < 3000; ++i) wanted.push_back(8192 + random() % 9000);  // leaves pages without a bit in between
  TriangleBits bits(kTriangles);
  tbb::parallel_for(std::size_t{0}, 4 * wanted.size(), [&](std::size_t i) { bits.set(wanted[i % wanted.size()]); });
  const std::set<std::uint64_t> all(wanted.begin(), wanted.end());
  EXPECT_EQ(bits.count(), all.size());
  EXPECT_EQ(bits_of(bits, 0, kTriangles), std::vector<std::uint64_t>(all.begin(), all.end()));
  for (int i = 0; i < 200; ++i) {
    std::uint64_t first = random() % (kTriangles + 1), end = random() % (kTriangles + 1);
    if (i % 2 == 0) first = 8192 + random() % 9000, end = first + random() % 200;
    if (first > end) std::swap(first, end);
    EXPECT_EQ(bits_of(bits, first, end), std::vector<std::uint64_t>(all.lower_bound(first), all.lower_bound(end)))
        << first << " to " << end;
  }
}

TEST(TriangleBits, OfNoTriangleAreNone) {
  const TriangleBits none(0);
  EXPECT_EQ(none.count(), 0U);
  EXPECT_TRUE(bits_of(none, 0, 0).empty());
}

}  // namespace
}  // namespace penumbra::visibility
