// SPDX-License-Identifier: Apache-2.0
// Records the shadow width map: occluders drawn without the ground, then distances in two passes (width_map.comp).

#include "maps/single_shadow/width_map.hpp"

#include "maps/host/map_fit.hpp"
#include "maps/products/slices.hpp"
#include "maps/single_shadow/width_map.comp.spv.hpp"
#include "maps/single_shadow/width_map.shared.h"

#include <algorithm>
#include <span>

namespace penumbra::maps {

WidthMap::WidthMap(const render::Device& device, std::uint32_t radius, Rasteriser rasteriser)
    : device_(&device),
      radius_(radius),
      rasteriser_(rasteriser),
      pass_(device, {.name = "shadow widths",
                     .spirv = shaders::kWidthMapComp,
                     .push_bytes = sizeof(gpu::WidthMapPush),
                     .constants = {}}) {}

void WidthMap::record(render::Commands& commands, const MapSet& maps) {
  const std::uint64_t texels = std::uint64_t{maps.size} * maps.size, bytes = texels * sizeof(float);
  for (auto* buffer : {&occluders_, &rows_, &widths_}) {
    render::grow(*device_, *buffer, "shadow widths", std::max(maps.faces, 1U) * bytes);
  }
  if (maps.faces == 0) return;
  gpu::LightView view{};
  maps.views.read<gpu::LightView>(std::span(&view, 1));
  const std::uint32_t ground = ground_of(maps.scene, maps.light, maps.basis);
  visibility::SceneFloats drawn = maps.scene;
  for (std::size_t i = 0; i < drawn.casts_shadow.size(); ++i) {
    if (drawn.object[i] == ground) drawn.casts_shadow[i] = 0;
  }
  grounds_ = std::ranges::find(drawn.object, ground) != drawn.object.end() ? 1 : 0;
  occluders_count_ =
      static_cast<std::uint64_t>(std::ranges::count_if(drawn.casts_shadow, [](auto casts) { return casts != 0; }));
  if (!occluder_maps_) occluder_maps_.emplace(*device_, maps.size, rasteriser_);
  occluder_maps_->upload(drawn);
  occluder_maps_->record(commands, view, maps.basis, maps.light.index, *occluders_, 0);
  for (std::uint32_t face = 0; face < maps.faces; ++face) {
    const Face seen = face_of(view, maps.basis, face);
    gpu::WidthMapPush push{.texel = glm::vec2((seen.upper - seen.lower) / static_cast<double>(maps.size)),
                           .size = maps.size,
                           .first = static_cast<std::uint32_t>(face * texels),
                           .radius = radius_,
                           .down = 0};
    for (push.down = 0; push.down < 2; ++push.down) {
      pass_.record(commands, push, {*occluders_, *rows_, *widths_}, (texels + 63) / 64);
    }
  }
}

void WidthMap::add_counters(std::map<std::string, std::uint64_t>& counters) const {
  counters["groundObjects"] = grounds_;
  counters["occludingTriangles"] = occluders_count_;
}

std::uint64_t WidthMap::memory_bytes() const {
  std::uint64_t bytes = occluder_maps_ ? occluder_maps_->memory_bytes() : 0;
  for (const auto* buffer : {&occluders_, &rows_, &widths_}) bytes += *buffer ? (*buffer)->bytes() : 0;
  return bytes;
}

}  // namespace penumbra::maps
