// SPDX-License-Identifier: Apache-2.0
// Converts masks from the layout of the device's kernels to that of visibility::Method::read_masks.

#include "engines/device/mask_layout.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <bit>

namespace penumbra::device {
namespace {

void arrange_pixel(const MaskLayout& layout, std::span<const std::uint32_t> from, std::span<std::uint32_t> mask) {
  if (layout.light_sample.empty()) {
    std::copy(from.begin(), from.end(), mask.begin());
    return;
  }
  std::fill(mask.begin(), mask.end(), 0U);
  for (std::uint32_t word = 0; word < from.size(); ++word) {
    for (std::uint32_t left = from[word]; left != 0; left &= left - 1) {
      const std::uint32_t j = layout.light_sample[32 * word + static_cast<std::uint32_t>(std::countr_zero(left))];
      if (j != MaskLayout::kNone) mask[j / 32] |= 1U << (j % 32);
    }
  }
}

}  // namespace

void arrange(const MaskLayout& layout, const visibility::Light& light, std::span<const std::uint32_t> counts,
             std::span<const std::uint32_t> of_kernels, std::span<std::uint32_t> masks) {
  const std::size_t words = light.words_per_mask(), own = layout.words;
  PENUMBRA_ASSERT(masks.size() == counts.size() * words && of_kernels.size() == counts.size() * own,
                  "{} words of {} for {} pixels", masks.size(), of_kernels.size(), counts.size());
  const std::uint32_t all = light.sample_count(), last = all % 32 == 0 ? ~0U : (1U << (all % 32)) - 1;
  for_each_index(counts.size(), [&](std::size_t pixel) {
    const auto mask = masks.subspan(pixel * words, words);
    if (counts[pixel] != 0 && counts[pixel] != all) {
      arrange_pixel(layout, of_kernels.subspan(pixel * own, own), mask);
      return;
    }
    std::fill(mask.begin(), mask.end(), counts[pixel] == 0 ? 0U : ~0U);
    mask.back() &= last;
  });
}

}  // namespace penumbra::device
