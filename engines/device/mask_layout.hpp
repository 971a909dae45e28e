// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/light_samples.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::device {

/// The light sample of each bit of a pixel's mask in the kernels' layout. A set bit means visible.
struct MaskLayout {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::uint32_t words = 0;                    ///< words for each pixel
  std::vector<std::uint32_t> light_sample{};  ///< light sample of bit b of word w at [32 w + b], or kNone; empty: bit j
                                              ///< is sample j

  [[nodiscard]] std::uint32_t sample_of(std::uint32_t bit) const {
    return light_sample.empty() ? bit : light_sample[bit];
  }
};

/// Converts kernels' masks to the layout of visibility::Method::read_masks. `counts`: number of visible light samples
/// of each pixel; if none or all are visible, the kernels' mask is undefined.
void arrange(const MaskLayout& layout, const visibility::Light& light, std::span<const std::uint32_t> counts,
             std::span<const std::uint32_t> of_kernels, std::span<std::uint32_t> masks);

}  // namespace penumbra::device
