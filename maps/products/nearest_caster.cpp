#include "maps/products/nearest_caster.hpp"

#include "maps/products/nearest_caster.comp.spv.hpp"
#include "maps/products/nearest_caster.shared.h"

namespace penumbra::maps {

NearestCaster::NearestCaster(const render::Device& device)
    : pass_(device, {.name = "nearest caster",
                     .spirv = shaders::kNearestCasterComp,
                     .push_bytes = sizeof(gpu::NearestPush),
                     .constants = {}}),
      nearest_(device, "nearest caster", 2 * sizeof(float)) {}

void NearestCaster::record(render::Commands& commands, const MapSet& maps) {
  commands.fill(nearest_, 0x7f800000u);  // infinity
  const gpu::NearestPush push{maps.size, maps.faces};
  pass_.record(commands, push, {maps.views, maps.depths, nearest_}, std::uint64_t{maps.faces} * maps.size);
}

}  // namespace penumbra::maps
