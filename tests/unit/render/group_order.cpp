// SPDX-License-Identifier: Apache-2.0
// Tests that each workgroup gets a different number, and that on a processor every consecutive part of a launch has
// workgroups from all over the picture.

#include "tests/agreement/support.hpp"
#include "tests/unit/render/group_order.comp.spv.hpp"

#include "render/buffer.hpp"
#include "render/commands.hpp"
#include "render/compute_pass.hpp"
#include "render/group_order.shared.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace penumbra::render {
namespace {

using GroupOrder = tests::DeviceTest;

TEST_F(GroupOrder, NumbersEachWorkgroupOnce) {
  const ComputePass pass(device(), {.name = "group order", .spirv = shaders::kGroupOrderComp});
  // The last count needs a launch in two dimensions, with one workgroup more than wanted.
  for (const std::uint32_t count : {1U, 63U, 64U, 65U, 1000U, 4096U, 70001U}) {
    const std::vector<std::uint32_t> zeros(count, 0);
    const Buffer numbers = make_buffer<std::uint32_t>(device(), "numbers", zeros),
                 counts = make_buffer<std::uint32_t>(device(), "counts", zeros);
    Commands commands(device());
    pass.record(commands, std::span<const std::byte>(), std::vector<BufferReference>{numbers, counts}, count);
    commands.submit();
    std::vector<std::uint32_t> number_of(count), often(count);
    numbers.read(std::span(number_of));
    counts.read(std::span(often));
    EXPECT_EQ(std::ranges::count(often, 1U), count) << count;
    if (device().info().kind != "cpu") {
      EXPECT_TRUE(std::ranges::is_sorted(number_of)) << count << ": a GPU keeps the order of launch";
      continue;
    }
    // Half of any eighth of a launch is in the first half of the picture, up to a strip at each end and the remainder.
    if (count < 4096) continue;
    for (std::uint32_t part = 0; part < 8; ++part) {
      const std::size_t first = std::size_t{part} * (count / 8);
      const auto in_first_half = std::ranges::count_if(std::span(number_of).subspan(first, count / 8),
                                                       [&](std::uint32_t n) { return n < count / 2; });
      EXPECT_NEAR(static_cast<double>(in_first_half), count / 16.0, 2.0 * gpu::kStripsOnProcessor)
          << count << ", part " << part;
    }
  }
}

}  // namespace
}  // namespace penumbra::render
