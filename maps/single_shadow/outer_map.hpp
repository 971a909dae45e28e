// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/caster_maps.hpp"
#include "maps/host/map_method.hpp"
#include "maps/single_shadow/outer_edges.hpp"
#include "render/opengl/raster_pass.hpp"
#include "render/raster_pass.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace penumbra::maps {

/// Second map from the light's centre. For each texel, it holds the position in the penumbra of the nearest silhouette
/// of the surface seen there, caster or not: 0 at the silhouette and 1 where all light is seen; and the least height of
/// the edges drawn there, infinite where there are none. Drawn by triangles beside every silhouette edge, as seen from
/// the light's centre.
class OuterMap final : public MapProduct {
 public:
  struct Options {
    OuterForm form = OuterForm::cones;
    /// Width of smoothies, at distance 1 from the light's centre; 0: the light's radius divided by the mean height of
    /// the silhouettes.
    double width = 0;
    Rasteriser rasteriser = Rasteriser::vulkan;
  };
  OuterMap(const render::Device& device, const Options& options);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *outer_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;
  void add_counters(std::map<std::string, std::uint64_t>& counters) const override;

 private:
  void record_surfaces(render::Commands& commands, const MapSet& maps, const gpu::LightView& view);
  void draw(render::Commands& commands, const MapSet& maps, const std::vector<gpu::OuterPush>& faces,
            const gpu::LightView& view);
  void draw_by_opengl(const std::vector<gpu::OuterPush>& faces, const gpu::LightView& view, std::size_t texels) const;

  const render::Device* device_;
  Options options_;
  std::optional<render::RasterPass> pass_;                 // used with Vulkan
  std::optional<render::opengl::RasterPass> opengl_pass_;  // used with OpenGL
  std::optional<CasterMaps> surface_maps_;                 ///< maps of all objects that cast or receive
  OuterEdges edges_;
  std::vector<render::Buffer> uploaded_;  ///< edges, one buffer for each side
  std::unique_ptr<render::Buffer> surfaces_, outer_;
};

}  // namespace penumbra::maps
