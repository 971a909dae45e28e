// SPDX-License-Identifier: Apache-2.0
#pragma once

// Maps of a stage's light from its centre, rendered as methods do, and read back.

#include "maps/host/caster_maps.hpp"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/host/map_method.hpp"
#include "selftest/small_scenes.hpp"

#include <glm/common.hpp>

#include <vector>

namespace penumbra::selftest {

struct CentreMaps {
  /// Further options of the maps: the number of peeled layers, and whether the farthest surfaces follow them; windows
  /// for all occluders of the light, or for all casters; and the rasteriser.
  struct More {
    std::uint32_t layers = 1;
    bool farthest = false, whole_light = false, all_casters = false;
    maps::Rasteriser rasteriser = maps::Rasteriser::vulkan;
  };
  CentreMaps(const render::Device& device, const Stage& stage, std::uint32_t texels, const glm::dvec2& beside,
             const More& more)
      : size(texels),
        basis(maps::light_basis(stage.light, stage.floats)),
        centre(basis.center),
        fitted(maps::fit_views(stage.floats, stage.light, basis, std::span(&centre, 1),
                               {.size = texels, .beside = beside, .reach = reach_of(stage, basis, more)})),
        views(render::make_buffer<maps::gpu::LightView>(device, "views", fitted.views)),
        depths(device, "depths", texel_count() * (more.layers + (more.farthest ? 1 : 0)) * sizeof(float)) {
    maps::CasterMaps casters(device, size, more.rasteriser);
    casters.upload(stage.floats);
    render::Commands commands(device);
    const maps::gpu::LightView& view = fitted.views.front();
    casters.record(commands, view, basis, stage.light.index, depths, 0);
    for (std::uint64_t layer = 1; layer < more.layers; ++layer) {
      casters.record_behind(commands, view, basis, stage.light.index, depths, layer * fitted.faces,
                            (layer - 1) * fitted.faces);
    }
    if (more.farthest) {
      casters.record_farthest(commands, view, basis, stage.light.index, depths,
                              std::uint64_t{more.layers} * fitted.faces);
    }
    commands.submit();
  }
  CentreMaps(const render::Device& device, const Stage& stage, std::uint32_t texels, const glm::dvec2& beside = {0, 0})
      : CentreMaps(device, stage, texels, beside, More()) {}
  /// Returns the number of texels of one layer.
  [[nodiscard]] std::size_t texel_count() const { return std::size_t{size} * size * std::max(fitted.faces, 1U); }
  [[nodiscard]] std::vector<float> read() const {
    std::vector<float> texels(depths.bytes() / sizeof(float));
    depths.read<float>(texels);
    return texels;
  }
  /// Returns the maps in the form given to products by a method.
  [[nodiscard]] maps::MapSet set(const Stage& stage) const {
    return {views, depths, fitted.faces, size, stage.light, basis, stage.floats};
  }

  std::uint32_t size;
  maps::LightBasis basis;
  glm::vec3 centre;
  maps::FittedViews fitted;
  render::Buffer views, depths;

 private:
  static glm::dvec2 reach_of(const Stage& stage, const maps::LightBasis& basis, const More& more) {
    if (more.all_casters) return maps::reach_of_all(stage.floats);
    if (!more.whole_light) return glm::dvec2(0);
    const maps::LightBounds bounds = maps::light_bounds(stage.light, basis);
    return glm::max(-bounds.lower, bounds.upper);
  }
};

}  // namespace penumbra::selftest
