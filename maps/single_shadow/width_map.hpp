// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/caster_maps.hpp"
#include "maps/host/map_method.hpp"
#include "render/compute_pass.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace penumbra::maps {

/// Shadow width map of Kirsch and Döllner 2003: for each texel of the maps of a light's centre that holds an occluder
/// (a caster that is not the ground, see ground_of) the distance to the nearest texel without one, in coordinates of
/// the face; 0 for a texel without an occluder, 1e30 if the distance is above `radius` texels.
class WidthMap final : public MapProduct {
 public:
  WidthMap(const render::Device& device, std::uint32_t radius, Rasteriser rasteriser);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *widths_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;
  /// Adds groundObjects, 0 or 1, and occludingTriangles, the number of casting triangles that do not belong to the
  /// ground.
  void add_counters(std::map<std::string, std::uint64_t>& counters) const override;

 private:
  const render::Device* device_;
  std::uint32_t radius_;
  Rasteriser rasteriser_;
  render::ComputePass pass_;
  std::optional<CasterMaps> occluder_maps_;
  std::uint64_t grounds_ = 0, occluders_count_ = 0;
  std::unique_ptr<render::Buffer> occluders_, rows_, widths_;
};

}  // namespace penumbra::maps
