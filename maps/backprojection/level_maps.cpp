#include "maps/backprojection/level_maps.hpp"

#include "maps/backprojection/level_maps.comp.spv.hpp"

namespace penumbra::maps {

LevelMaps::LevelMaps(const render::Device& device, std::uint32_t level)
    : device_(&device),
      level_(level),
      pass_(device, {.name = "level of maps",
                     .spirv = shaders::kLevelMapsComp,
                     .push_bytes = sizeof(gpu::LevelPush),
                     .constants = {}}),
      levels_(std::make_unique<render::Buffer>(device, "level of maps", 2 * sizeof(std::uint32_t))) {}

void LevelMaps::record(render::Commands& commands, const MapSet& maps) {
  if (level_ == 0 || maps.faces == 0) return;
  const std::uint64_t side = gpu::level_size(maps.size, level_), texels = maps.layers * maps.faces * side * side;
  render::grow(*device_, levels_, "level of maps", texels * 2 * sizeof(std::uint32_t));
  const gpu::LevelPush push{maps.size, level_, maps.layers * maps.faces};
  pass_.record(commands, push, {maps.depths, *levels_}, (texels + 63) / 64);
}

}  // namespace penumbra::maps
