#pragma once

#include "maps/host/map_method.hpp"
#include "render/compute_pass.hpp"

namespace penumbra::maps {

/// The option `depth` where texels are filtered before they are asked: the first layer of the maps becomes the depth at
/// which each texel's shadow begins (shadow_depths.glsl). The first product of its recipe; a look-up binds nothing of
/// it.
class ShadowDepths final : public MapProduct {
 public:
  /// `bias`: in texels, that the look-up takes off receivers' heights; 0 if it takes none.
  ShadowDepths(const render::Device& device, DepthUse depth, double bias);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override;
  [[nodiscard]] std::vector<render::BufferReference> buffers() const override { return {}; }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return 0; }

 private:
  render::ComputePass pass_;
  DepthUse depth_;
  float bias_;
  const render::Buffer* maps_ = nullptr;  ///< that were changed last
};

}  // namespace penumbra::maps
