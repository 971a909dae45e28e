// SPDX-License-Identifier: Apache-2.0
// Computes the depth at which shadows begin (Wang and Molnar 1994, Woo 1992, Weiskopf and Ertl 2003), for methods that
// use means of depths.

#include "maps/products/shadow_depths.hpp"

#include "base/assert.hpp"
#include "maps/products/shadow_depths.comp.spv.hpp"
#include "maps/products/shadow_depths.shared.h"
#include "maps/products/shadow_depths_fitted.comp.spv.hpp"

namespace penumbra::maps {

ShadowDepths::ShadowDepths(const render::Device& device, DepthUse depth, double bias)
    : device_(&device),
      pass_(device, {.name = "shadow depths",
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
  const std::uint64_t groups = (texels + 63) / 64;
  if (maps.face_table != nullptr) {
    if (!fitted_) {
      fitted_.emplace(*device_, render::ComputePassOptions{.name = "shadow depths",
                                                           .spirv = shaders::kShadowDepthsFittedComp,
                                                           .push_bytes = sizeof(gpu::ShadowDepthsPush),
                                                           .constants = {}});
    }
    return fitted_->record(commands, push, {maps.depths, *maps.face_table}, groups);
  }
  pass_.record(commands, push, {maps.depths, maps.views}, groups);
}

const render::Buffer& ShadowDepths::buffer() const {
  PENUMBRA_ASSERT(maps_ != nullptr, "{}", "the depths of shadows before the maps");
  return *maps_;
}

}  // namespace penumbra::maps
