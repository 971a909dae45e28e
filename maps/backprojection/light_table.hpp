// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/backprojection/light_table.shared.h"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_method.hpp"

#include <vector>

namespace penumbra::maps {

/// Planar light in the form used for cutting by patches: the fraction of the light in any axis-parallel rectangle, by
/// differences of a table of prefix sums (Crow 1984), bilinear between its nodes. Exact for a rectangle light: one
/// cell, or one for each texel of its texture, weighted by luminance. Other lights have 256 × 256 cells over their
/// bounding rectangle, with the exact fraction of the light below and left of each node. A sphere has the table of its
/// disk.
struct LightTableData {
  gpu::LightTableHead head;
  std::vector<float> outline;  ///< x, y of each corner
  std::vector<float> shares;   ///< (width + 1)(height + 1)
};
LightTableData light_table(const visibility::Light& light, const LightBasis& basis);

/// Buffer of light_table on the device, read by light_table.glsl.
class LightTable final : public MapProduct {
 public:
  explicit LightTable(const render::Device& device) : device_(&device) {}
  void record(render::Commands& commands, const MapSet& maps) override;
  /// Writes the table of a light, immediately.
  void write(const LightTableData& data);
  [[nodiscard]] const render::Buffer& buffer() const override;

 private:
  const render::Device* device_;
  std::unique_ptr<render::Buffer> table_;
};

}  // namespace penumbra::maps
