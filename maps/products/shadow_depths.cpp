// SPDX-License-Identifier: Apache-2.0
// Computes the depth at which shadows begin (Wang and Molnar 1994, Woo 1992, Weiskopf and Ertl 2003), for methods that
// use means of depths.

#include "maps/products/shadow_depths.hpp"

#include "base/assert.hpp"
#include "maps/products/shadow_depths.comp.spv.hpp"
#include "maps/products/shadow_depths.shared.h"

namespace penumbra::maps {

ShadowDepths::ShadowDepths(const render::Device& device, DepthUse depth, double bias)
    : pass_(device, {.name = "shadow depths",
                     .spirv = shaders::kShadowDepthsComp,
                     .push_bytes = sizeof(gpu::ShadowDepthsPush),
                     .constants = {}}),
      depth_(depth),
      bias_(static_cast<float>(bias)) {}

void ShadowDepths::record(render::Commands& commands, const MapSet& maps) {
  maps_ = &maps.depths;
  if (depth_ == DepthUse::first || maps.faces == 0) return;
  const gpu::ShadowDepthsPush push{maps.size, maps.faces, static_cast<std::uint32_t>(depth_), bias_};
  const std::uint64_t texels = std::uint64_t{maps.faces} * maps.size * maps.size;
  pass_.record(commands, push, {maps.depths, maps.views}, (texels + 63) / 64);
}

const render::Buffer& ShadowDepths::buffer() const {
  PENUMBRA_ASSERT(maps_ != nullptr, "{}", "the depths of shadows before the maps");
  return *maps_;
}

}  // namespace penumbra::maps
