// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/backprojection/patches/light_sample_bands.shared.h"
#include "maps/host/light_basis.hpp"
#include "maps/host/map_method.hpp"

#include <vector>

namespace penumbra::maps {

/// Returns the light samples in bands across the light, so that samples in a small part of the light are found quickly:
/// as many bands as there are rows if the samples are in rows, else √N.
std::vector<std::uint32_t> light_sample_bands(const visibility::Light& light, const LightBasis& basis);

/// Buffer of light_sample_bands on the device, as words; read by sample_bands.glsl.
class LightSampleBands final : public MapProduct {
 public:
  explicit LightSampleBands(const render::Device& device) : device_(&device) {}
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override;

 private:
  const render::Device* device_;
  std::unique_ptr<render::Buffer> bands_;
};

}  // namespace penumbra::maps
