// SPDX-License-Identifier: Apache-2.0
// Records the minimum of depths of the centre's maps (nearest_caster.comp).

#include "maps/products/nearest_caster.hpp"

#include "maps/products/nearest_caster.comp.spv.hpp"
#include "maps/products/nearest_caster.shared.h"
#include "maps/products/nearest_caster_fitted.comp.spv.hpp"

namespace penumbra::maps {

NearestCaster::NearestCaster(const render::Device& device)
    : device_(&device),
      pass_(device, {.name = "nearest caster",
                     .spirv = shaders::kNearestCasterComp,
                     .push_bytes = sizeof(gpu::NearestPush),
                     .constants = {}}),
      nearest_(device, "nearest caster", 2 * sizeof(float)) {}

void NearestCaster::record(render::Commands& commands, const MapSet& maps) {
  commands.fill(nearest_, 0x7f800000u);  // infinity
  const gpu::NearestPush push{maps.size, maps.faces};
  const std::uint64_t groups = std::uint64_t{maps.faces} * maps.size;
  if (maps.face_table != nullptr) {
    if (!fitted_) {
      fitted_.emplace(*device_, render::ComputePassOptions{.name = "nearest caster",
                                                           .spirv = shaders::kNearestCasterFittedComp,
                                                           .push_bytes = sizeof(gpu::NearestPush),
                                                           .constants = {}});
    }
    return fitted_->record(commands, push, {maps.views, maps.depths, nearest_, *maps.face_table}, groups);
  }
  pass_.record(commands, push, {maps.views, maps.depths, nearest_}, groups);
}

}  // namespace penumbra::maps
