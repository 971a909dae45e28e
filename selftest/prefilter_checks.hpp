#pragma once

#include "maps/products/prefilter.hpp"
#include "render/device.hpp"
#include "selftest/check.hpp"
#include "selftest/small_scenes.hpp"

#include <cstdint>

namespace penumbra::selftest {

/// Prefilter's summed areas, differenced again to digits: of every kind of function of a texel's height, what the
/// digits add up to against the function in double.
Check check_prefilter_tables(const render::Device& device, const Stage& stage, std::uint32_t size);

/// Prefilter's mip levels or N-buffers: the finest level against the functions in double, each other one bit by bit
/// against the sums of four of the level before.
Check check_prefilter_levels(const render::Device& device, const Stage& stage, std::uint32_t size,
                             maps::PrefilterKind kind);

}  // namespace penumbra::selftest
