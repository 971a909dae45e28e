#pragma once

#include "maps/host/map_method.hpp"
#include "maps/products/lists/sample_maps.hpp"
#include "render/compute_pass.hpp"

#include <optional>

namespace penumbra::maps {

/// A layered depth image from the light's centre (Agrawala, Ramamoorthi, Heirich and Moll 2000): for each texel the
/// surfaces that light samples see in its direction, and how many of them do.
///
/// The buffer holds `layers()` entries (gpu::LayerEntry) for each texel, those that are none with weight 0.
class LayeredDepth final : public MapProduct {
 public:
  /// `epsilon`: depths that differ by no more than this share of them are one surface.
  LayeredDepth(const render::Device& device, double epsilon, Rasteriser rasteriser = Rasteriser::vulkan);
  void make(const MapSource& source) override;
  void record(render::Commands& /*commands*/, const MapSet& /*maps*/) override {}
  [[nodiscard]] const render::Buffer& buffer() const override { return *entries_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;
  /// Entries a texel, as the product was last made.
  [[nodiscard]] std::uint32_t layers() const { return layers_; }
  [[nodiscard]] std::uint32_t total_weight() const { return samples_.total(); }

 private:
  /// Warps and merges all samples with room for `layers_` and `nodes_` nodes; false if there was too little.
  bool merge_all(const MapSource& source);
  /// Renders maps of what receives shadow and casts none: samples see it, too, where no caster is before it.
  void make_others(const MapSource& source);

  const render::Device* device_;
  double epsilon_;
  Rasteriser rasteriser_;
  SampleMaps samples_;
  std::optional<SampleMaps> others_;  ///< nothing where all receivers cast
  render::ComputePass warp_, merge_;
  std::uint32_t layers_ = 4;
  std::uint64_t node_capacity_ = 0;
  std::unique_ptr<render::Buffer> centre_, heads_, nodes_, node_count_, counts_, entries_, most_;
};

}  // namespace penumbra::maps
