// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "maps/products/lists/sample_maps.hpp"
#include "render/compute_pass.hpp"

#include <optional>

namespace penumbra::maps {

/// Layered depth image from the light's centre (Agrawala, Ramamoorthi, Heirich and Moll 2000): for each texel the
/// surfaces seen by light samples in its direction, and the number of these samples.
///
/// The buffer holds `layers()` entries (gpu::LayerEntry) for each texel; unused entries have weight 0.
class LayeredDepth final : public MapProduct {
 public:
  /// `epsilon`: depths that differ by at most this fraction are one surface.
  LayeredDepth(const render::Device& device, double epsilon, Rasteriser rasteriser = Rasteriser::vulkan);
  void make(const MapSource& source) override;
  void record(render::Commands& /*commands*/, const MapSet& /*maps*/) override {}
  [[nodiscard]] const render::Buffer& buffer() const override { return *entries_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;
  /// Returns the number of entries of a texel in the most recently made product.
  [[nodiscard]] std::uint32_t layers() const { return layers_; }
  [[nodiscard]] std::uint32_t total_weight() const { return samples_.total(); }

 private:
  /// Warps and merges all samples with room for `layers_` and `nodes_` nodes; returns false if the room was
  /// insufficient.
  bool merge_all(const MapSource& source);
  /// Renders maps of receivers that cast no shadow: samples see these, too, where no caster is in front.
  void make_others(const MapSource& source);

  const render::Device* device_;
  double epsilon_;
  Rasteriser rasteriser_;
  SampleMaps samples_;
  std::optional<SampleMaps> others_;  ///< empty if all receivers cast shadow
  render::ComputePass warp_, merge_;
  std::uint32_t layers_ = 4;
  std::uint64_t node_capacity_ = 0;
  std::unique_ptr<render::Buffer> centre_, heads_, nodes_, node_count_, counts_, entries_, most_;
};

}  // namespace penumbra::maps
