// SPDX-License-Identifier: Apache-2.0
// Tests that the kept lanes of a vector are stored side by side: every choice of lanes, on every vector unit of this
// processor.

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/unit/pack.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "engines/vectors/pack-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace penumbra::vectors::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <typename Lane>
void expect_kept_lanes() {
  using Tag = hn::ScalableTag<Lane>;
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  std::vector<Lane> values(lanes), expected, found(2 * lanes);
  std::vector<std::uint8_t> bits((lanes + 7) / 8 + 8);
  for (std::size_t i = 0; i < lanes; ++i) values[i] = static_cast<Lane>(100 + i);
  for (std::size_t choice = 0; choice < std::size_t{1} << lanes; ++choice) {
    expected.clear();
    for (std::size_t i = 0; i < lanes; ++i) {
      if ((choice >> i & 1) != 0) expected.push_back(values[i]);
    }
    for (std::size_t byte = 0; byte < (lanes + 7) / 8; ++byte)
      bits[byte] = static_cast<std::uint8_t>(choice >> 8 * byte);
    const auto kept = hn::LoadMaskBits(d, bits.data());
    ASSERT_EQ(pack(hn::LoadU(d, values.data()), kept, d, found.data()), expected.size()) << choice;
    ASSERT_EQ(std::vector<Lane>(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(expected.size())), expected)
        << choice << " of " << lanes << " lanes of " << sizeof(Lane) << " bytes, " << hwy::TargetName(HWY_TARGET);
  }
}

void expect_kept_lanes_of_all() {
  expect_kept_lanes<float>();
  expect_kept_lanes<double>();
  expect_kept_lanes<std::int32_t>();
  expect_kept_lanes<std::uint32_t>();
}

}  // namespace
}  // namespace penumbra::vectors::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::vectors {

HWY_EXPORT(expect_kept_lanes_of_all);

TEST(Pack, KeepsEachChoiceInOrder) {
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    HWY_DYNAMIC_DISPATCH(expect_kept_lanes_of_all)();
    hwy::SetSupportedTargetsForTest(0);
  }
}

}  // namespace penumbra::vectors
#endif
