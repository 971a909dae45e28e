// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/method_options.hpp"

#include <cstdint>

namespace penumbra::hybrids {

enum class HybridVariant : std::uint8_t { chan_durand, mccool };

inline constexpr visibility::ChoiceOption kVariant{
    "variant",
    {{"chan-durand", HybridVariant::chan_durand}, {"mccool", HybridVariant::mccool}},
    HybridVariant::chan_durand,
    "chan-durand: the map where its texels agree, volumes elsewhere; mccool: volumes that are reconstructed from the "
    "map's jumps in depth"};
inline constexpr visibility::RealOption kJump{
    "jump", 0, 1048576, 2,
    "mccool: largest difference in depth of neighbouring texels on one surface, in widths of a texel"};

}  // namespace penumbra::hybrids
