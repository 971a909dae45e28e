// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/backprojection/level_maps.shared.h"
#include "maps/host/map_method.hpp"
#include "render/compute_pass.hpp"

#include <cstdint>
#include <memory>

namespace penumbra::maps {

/// Coarse levels of all layers of a light's maps (Schwarz and Stamminger 2007, 2008), one after the other: the nearest
/// depth of each block of 2^level texels a side, and the box around its non-empty texels. Two words a texel; level 0 is
/// not stored.
class LevelMaps final : public MapProduct {
 public:
  LevelMaps(const render::Device& device, std::uint32_t first, std::uint32_t last);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *levels_; }

 private:
  const render::Device* device_;
  std::uint32_t first_, last_;
  render::ComputePass pass_;
  std::unique_ptr<render::Buffer> levels_;
};

}  // namespace penumbra::maps
