// SPDX-License-Identifier: Apache-2.0
#include "compare/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <tuple>

namespace penumbra::compare {
namespace {

using visibility::PixelClass;

TEST(PixelSets, ByClassAndByAlpha) {
  const std::vector<PixelClass> classes{PixelClass::background, PixelClass::judged, PixelClass::horizon,
                                        PixelClass::judged, PixelClass::emitter};
  EXPECT_EQ(pixels_of_class(classes, PixelClass::judged), (std::vector<std::uint32_t>{1, 3}));
  EXPECT_EQ(pixels_of_class(classes, PixelClass::behind), std::vector<std::uint32_t>{});
  visibility::ViewSamples samples;
  samples.triangle = {-1, 0, 5, -1};
  EXPECT_EQ(pixels_with_alpha(samples), (std::vector<std::uint32_t>{1, 2}));
}

TEST(VisibilityErrorTest, OfFourPixels) {
  // Errors +0.5, −0.25, 0, +0.03125 (all exact in float); pixel 4 is not judged and very wrong.
  const std::vector<float> v{0.75f, 0.25f, 1.0f, 0.53125f, 1.0f}, reference{0.25f, 0.5f, 1.0f, 0.5f, 0.0f};
  const std::vector<std::uint32_t> pixels{0, 1, 2, 3};
  const VisibilityError error = visibility_error(v, reference, pixels).value();
  EXPECT_DOUBLE_EQ(error.mean, 0.78125 / 4);
  EXPECT_DOUBLE_EQ(error.bias, 0.28125 / 4);
  EXPECT_DOUBLE_EQ(error.rmse, std::sqrt((0.25 + 0.0625 + 0.0009765625) / 4));
  EXPECT_DOUBLE_EQ(error.max, 0.5);
  EXPECT_DOUBLE_EQ(error.p999, 0.5);  // rank ⌈3.996⌉ = 4
  EXPECT_DOUBLE_EQ(error.over05, 0.5);
}

TEST(VisibilityErrorTest, NoPixelsNoError) {
  EXPECT_EQ(visibility_error({}, {}, {}), std::nullopt);
}

TEST(VisibilityErrorTest, PercentileIsTheNearestRank) {
  // |e| = i / 4096 for i = 0 … 1999. At least 0.999 · 2000 = 1998 pixels must not exceed the percentile: it is the
  // 1998th value, 1997.
  std::vector<float> v(2000), reference(2000, 0.0f);
  for (std::size_t i = 0; i < v.size(); ++i)
    v[(i * 7) % 2000] = static_cast<float>(i) / 4096.0f;  // 7 is coprime: shuffled
  std::vector<std::uint32_t> pixels(2000);
  std::iota(pixels.begin(), pixels.end(), 0u);
  EXPECT_DOUBLE_EQ(visibility_error(v, reference, pixels)->p999, 1997.0 / 4096);
  EXPECT_DOUBLE_EQ(visibility_error(v, reference, pixels)->max, 1999.0 / 4096);
  EXPECT_DOUBLE_EQ(visibility_error(v, reference, pixels)->over05, (1999.0 - 204) / 2000);  // 0.05 · 4096 = 204.8
  EXPECT_DOUBLE_EQ(visibility_error(reference, v, pixels)->bias, -1999.0 / 2 / 4096);
}

TEST(VisibilityErrorDeathTest, ANotANumberIsNeverCalledRight) {
  const std::vector<float> v{std::nanf("")}, reference{1.0f};
  const std::vector<std::uint32_t> pixels{0};
  EXPECT_DEATH((void)visibility_error(v, reference, pixels), "V is nan");
}

/// Four pixels of 34 samples, two words each: all seen, none seen, partly seen, all but one seen.
struct Masks {
  std::vector<std::uint32_t> method{0xffffffffu, 3, 0, 0, 0x0000ffffu, 1, 0xffffffffu, 3};
  std::vector<std::uint32_t> reference = method;
  std::vector<std::uint32_t> pixels{0, 1, 2, 3};
  [[nodiscard]] MaskPair pair() const { return {method, reference, 34}; }
};

TEST(BeautyErrorTest, IsRelativeToTheReferencesMean) {
  const std::vector<glm::vec3> reference{{1, 1, 1}, {3, 3, 3}, {9, 9, 9}}, beauty{{2, 2, 2}, {2, 2, 2}, {9, 9, 9}};
  const std::vector<std::uint32_t> first_two{0, 1}, none;
  const auto error = beauty_error(beauty, reference, first_two);
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->relative_rmse, 0.5, 1e-15);  // errors of 1 under a mean of 2
  EXPECT_NEAR(error->relative_bias, 0, 1e-15);
  // Red alone counts 0.2126.
  const std::vector<glm::vec3> red{{2, 1, 1}};
  const std::vector<std::uint32_t> first{0};
  EXPECT_NEAR(beauty_error(red, reference, first)->relative_bias, 0.2126, 1e-15);
  EXPECT_FALSE(beauty_error(beauty, reference, none).has_value());
  const std::vector<glm::vec3> black(3, glm::vec3(0));
  EXPECT_FALSE(beauty_error(beauty, black, first_two).has_value());
}

TEST(Pairs, EqualMasks) {
  const Masks masks;
  const PairCounts counts = count_pairs(masks.pair(), masks.pixels);
  EXPECT_EQ(counts.all, 4u * 34);
  EXPECT_EQ(counts.penumbra, 34u);  // pixel 2 alone is partly seen
  EXPECT_EQ(counts.differing, 0u);
}

TEST(Pairs, APixelInEithersPenumbraCounts) {
  Masks masks;
  masks.reference[0] ^= 1u << 31;  // sample 31 of pixel 0
  masks.method[7] ^= 2;            // sample 33 of pixel 3
  masks.reference[2] = 5;          // samples 0 and 2 of pixel 1
  masks.method[1] |= 0xfffffff0u;  // bits beyond the last sample: must not matter
  EXPECT_EQ(count_pairs(masks.pair(), masks.pixels), (PairCounts{4UL * 34, 4UL * 34, 4}));
  EXPECT_EQ(count_pairs(masks.pair(), std::vector<std::uint32_t>{0, 2}), (PairCounts{2UL * 34, 2UL * 34, 1}));

  std::vector<std::tuple<std::uint32_t, std::uint32_t, bool>> found;
  for_each_differing_pair(masks.pair(), masks.pixels, [&](std::uint32_t pixel, std::uint32_t sample, bool seen) {
    found.emplace_back(pixel, sample, seen);
  });
  const std::vector<std::tuple<std::uint32_t, std::uint32_t, bool>> expected{
      {0, 31, true}, {1, 0, false}, {1, 2, false}, {3, 33, false}};
  EXPECT_EQ(found, expected);
}

TEST(Pairs, CountsOfBandsAddUp) {
  PairCounts sum{10, 5, 1};
  sum += {100, 50, 2};
  EXPECT_EQ(sum, (PairCounts{110, 55, 3}));
}

}  // namespace
}  // namespace penumbra::compare
