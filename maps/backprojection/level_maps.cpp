// SPDX-License-Identifier: Apache-2.0
// Records the coarse levels of a light's maps (level_maps.comp), all layers and faces.

#include "maps/backprojection/level_maps.hpp"

#include "maps/backprojection/level_maps.comp.spv.hpp"

#include <algorithm>
#include <vector>

namespace penumbra::maps {

LevelMaps::LevelMaps(const render::Device& device, std::uint32_t first, std::uint32_t last)
    : device_(&device),
      first_(std::max(first, 1u)),
      last_(last),
      pass_(device, {.name = "level of maps",
                     .spirv = shaders::kLevelMapsComp,
                     .push_bytes = sizeof(gpu::LevelPush),
                     .constants = {}}),
      levels_(std::make_unique<render::Buffer>(device, "level of maps", 2 * sizeof(std::uint32_t))) {}

void LevelMaps::record(render::Commands& commands, const MapSet& maps) {
  const std::uint32_t images = maps.layers * maps.faces;
  std::vector<gpu::LevelPush> levels;
  std::uint64_t texels = 0;
  for (std::uint32_t level = first_; level <= last_ && images > 0; ++level) {
    levels.push_back({maps.size, level, images, static_cast<std::uint32_t>(texels)});
    const std::uint64_t side = gpu::level_size(maps.size, level);
    texels += images * side * side;
  }
  if (levels.empty()) return;
  render::grow(*device_, levels_, "levels of maps", texels * 2 * sizeof(std::uint32_t));
  for (const gpu::LevelPush& push : levels) {
    const std::uint64_t side = gpu::level_size(maps.size, push.level);
    pass_.record(commands, push, {maps.depths, *levels_}, (images * side * side + 63) / 64);
  }
}

}  // namespace penumbra::maps
