#pragma once

#include "visibility/light_samples.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::device {

/// Which light sample each bit of a pixel's mask is, as kernels like it. Set: visible.
struct MaskLayout {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::uint32_t words = 0;                    ///< a pixel
  std::vector<std::uint32_t> light_sample{};  ///< for bit b of word w at 32 w + b, or kNone; empty: bit j is sample j

  [[nodiscard]] std::uint32_t sample_of(std::uint32_t bit) const {
    return light_sample.empty() ? bit : light_sample[bit];
  }
};

/// Masks as visibility::Method::read_masks gives them, of kernels' masks and of how many light samples each pixel sees:
/// of one that sees none, or all, the mask may say anything.
void arrange(const MaskLayout& layout, const visibility::Light& light, std::span<const std::uint32_t> counts,
             std::span<const std::uint32_t> of_kernels, std::span<std::uint32_t> masks);

}  // namespace penumbra::device
