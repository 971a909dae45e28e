#pragma once

#include "maps/host/opengl_maps.hpp"
#include "render/device.hpp"
#include "selftest/check.hpp"
#include "selftest/small_scenes.hpp"

#include <cstdint>

namespace penumbra::selftest {

/// Who finds view samples: the device's visibility buffer, what OpenGL proposes, or the processor's scan conversion.
enum class ViewSampler : std::uint8_t { vulkan, opengl, vectors };

/// Every pixel's carrying triangle and point, bit by bit against `expected` (visibility::brute_force_view_samples).
Check check_view_samples(const render::Device& device, const visibility::SceneFloats& floats,
                         const visibility::ViewSamples& expected, ViewSampler sampler);

/// Maps from the light's centre, `size` texels a side: the nearest surface, three more behind it, and the farthest,
/// against RasterTwin with the rasteriser's own step.
Check check_maps(const render::Device& device, const Stage& stage, std::uint32_t size, maps::Rasteriser rasteriser);

/// The nearest and the farthest surfaces by both rasterisers: they may differ only where an edge passes within the sum
/// of both steps of a texel's centre, and by what the surface changes within it.
Check check_rasterisers_agree(const render::Device& device, const Stage& stage, std::uint32_t size);

}  // namespace penumbra::selftest
