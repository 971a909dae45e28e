// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/products/prefilter.hpp"
#include "render/device.hpp"
#include "selftest/check.hpp"
#include "selftest/small_scenes.hpp"

#include <cstdint>

namespace penumbra::selftest {

/// Compares Prefilter's summed areas, whose differences give the digits again: for every kind of function of a texel's
/// height, compares the sum of the digits with the function in double.
Check check_prefilter_tables(const render::Device& device, const Stage& stage, std::uint32_t size);

/// Compares Prefilter's mip levels or N-buffers: the finest level with the functions in double, each other level bit by
/// bit with the sums of four texels of the previous level.
Check check_prefilter_levels(const render::Device& device, const Stage& stage, std::uint32_t size,
                             maps::PrefilterKind kind);

}  // namespace penumbra::selftest
