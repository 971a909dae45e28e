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

/// A second map beside the one of the light's centre: for each texel how far out in the penumbra of the nearest
/// silhouette it is, 0 at the silhouette and 1 where all light is seen, for the surface that the light's centre sees
/// there, caster or not; and the least height of what is drawn there, infinite where nothing is. Drawn by triangles
/// beside every silhouette edge, as the light's centre sees it.
class OuterMap final : public MapProduct {
 public:
  struct Options {
    OuterForm form = OuterForm::cones;
    /// Of smoothies, 1 from the light's centre; 0: the light's radius over the mean height of the silhouettes.
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
  std::optional<render::RasterPass> pass_;                 // either this
  std::optional<render::opengl::RasterPass> opengl_pass_;  // or that
  std::optional<CasterMaps> surface_maps_;                 ///< of all that casts or receives
  OuterEdges edges_;
  std::vector<render::Buffer> uploaded_;  ///< edges, a buffer a side
  std::unique_ptr<render::Buffer> surfaces_, outer_;
};

}  // namespace penumbra::maps
