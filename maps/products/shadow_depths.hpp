// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "render/compute_pass.hpp"

#include <optional>

namespace penumbra::maps {

/// Option `depth` for methods that filter texels before the comparison: the first layer of the maps is replaced by the
/// depth at which each texel's shadow begins (shadow_depths.glsl). The first product of its recipe; a look-up binds
/// none of its buffers.
class ShadowDepths final : public MapProduct {
 public:
  /// `bias`: number of texels by which the look-up reduces receivers' heights; 0 if it does not.
  ShadowDepths(const render::Device& device, DepthUse depth, double bias);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override;
  [[nodiscard]] std::vector<render::BufferReference> buffers() const override { return {}; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return 0; }

 private:
  const render::Device* device_;
  render::ComputePass pass_;
  std::optional<render::ComputePass> fitted_;  ///< for MapSet::face_table
  DepthUse depth_;
  float bias_;
  const render::Buffer* maps_ = nullptr;  ///< most recently changed maps
};

}  // namespace penumbra::maps
