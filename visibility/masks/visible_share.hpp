#pragma once

#include "visibility/light_samples.hpp"

#include <cstdint>
#include <span>

namespace penumbra::visibility {

/// V of a mask (words_per_mask() words; bits beyond the last sample are 0): the share of its bits that are set, or of a
/// light with a texture the sum of their weights.
float visible_share(const Light& light, std::span<const std::uint32_t> mask);

/// V of many masks that lie one after the other. The number of threads changes nothing.
void visible_shares(const Light& light, std::span<const std::uint32_t> masks, std::span<float> visibility);

}  // namespace penumbra::visibility
