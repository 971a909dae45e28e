// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "maps/products/prefilter.hpp"
#include "render/device.hpp"
#include "selftest/centre_maps.hpp"
#include "selftest/check.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::selftest {

/// Compares NearestCaster, bit by bit: for each side of the light, the smallest height of its texels over the light's
/// plane.
Check check_nearest_caster(const render::Device& device, const Stage& stage, std::uint32_t size);

/// Compares NearestIds: each texel has a triangle that may be its nearest surface (RasterTwin), or no triangle if it
/// may have no surface.
Check check_nearest_ids(const render::Device& device, const Stage& stage, std::uint32_t size,
                        maps::Rasteriser rasteriser);

/// Compares SummedAreas of images of size² words, any number of them, modulo 2³² (Crow 1984). Bit by bit.
Check check_summed_areas(const render::Device& device, std::span<const std::uint32_t> images, std::uint32_t size);
/// Returns Crow's sums of one image, modulo 2³².
std::vector<std::uint32_t> summed_areas(std::span<const std::uint32_t> image, std::uint32_t size);

/// Compares DepthPyramid of `faces` maps: the header, and each node with the value computed from only its texels. Bit
/// by bit.
Check check_depth_pyramid(const render::Device& device, maps::PyramidKind kind, std::span<const float> depths,
                          std::uint32_t size, std::uint32_t faces);

/// Compares Slices of the casters: every certain surface of a texel is marked in its slice, and no slice is marked
/// where no surface may be (RasterTwin).
Check check_slices(const render::Device& device, const Stage& stage, std::uint32_t size, std::uint32_t count,
                   maps::Rasteriser rasteriser);

}  // namespace penumbra::selftest
