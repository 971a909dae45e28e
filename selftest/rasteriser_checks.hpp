// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/opengl_maps.hpp"
#include "render/device.hpp"
#include "selftest/check.hpp"
#include "selftest/small_scenes.hpp"

#include <cstdint>

namespace penumbra::selftest {

/// Source of view samples: the device's visibility buffer, candidates from OpenGL, or the processor's scan conversion.
enum class ViewSampler : std::uint8_t { vulkan, opengl, vectors };

/// Compares every pixel's carrying triangle and point, bit by bit with `expected`
/// (visibility::brute_force_view_samples).
Check check_view_samples(const render::Device& device, const visibility::SceneFloats& floats,
                         const visibility::ViewSamples& expected, ViewSampler sampler);

/// Compares maps from the light's centre, `size` texels a side: the nearest surface, three more behind, and the
/// farthest, with RasterTwin for the rasteriser's own step.
Check check_maps(const render::Device& device, const Stage& stage, std::uint32_t size, maps::Rasteriser rasteriser);

/// Compares the nearest and the farthest surfaces of both rasterisers: any difference is permitted where an edge passes
/// within the sum of both steps of a texel's centre; elsewhere only the change of the surface's depth within this sum.
Check check_rasterisers_agree(const render::Device& device, const Stage& stage, std::uint32_t size);

}  // namespace penumbra::selftest
