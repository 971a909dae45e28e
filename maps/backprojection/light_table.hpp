#pragma once

#include "maps/backprojection/light_table.shared.h"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_method.hpp"

#include <vector>

namespace penumbra::maps {

/// A planar light as patches cut it: how much of it lies in any axis-parallel rectangle, by differences of a table of
/// prefix sums (Crow 1984), bilinear between its nodes. Exact for a rectangle light: one cell, or one for each texel of
/// its texture, whose luminance it weighs by. Others have 256 × 256 cells over their bounding rectangle, with the exact
/// share of the light below and left of each node. A sphere's is that of its disk.
struct LightTableData {
  gpu::LightTableHead head;
  std::vector<float> outline;  ///< x, y of each corner
  std::vector<float> shares;   ///< (width + 1)(height + 1)
};
LightTableData light_table(const visibility::Light& light, const LightBasis& basis);

/// light_table on the device; light_table.glsl reads it.
class LightTable final : public MapProduct {
 public:
  explicit LightTable(const render::Device& device) : device_(&device) {}
  void record(render::Commands& commands, const MapSet& maps) override;
  /// Writes that of a light, at once.
  void write(const LightTableData& data);
  [[nodiscard]] const render::Buffer& buffer() const override;

 private:
  const render::Device* device_;
  std::unique_ptr<render::Buffer> table_;
};

}  // namespace penumbra::maps
