// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "maps/products/map_frame.shared.h"

namespace penumbra::maps {

/// Returns half the sides of the box, parallel to the basis, that replaces a light where windows must be boxes: the box
/// has the light's own second moments, so its half sides are √3 times their roots. A rectangle is its own box, a disk's
/// has half sides √3/2 radius.
glm::dvec2 half_box(const visibility::Light& light, const LightBasis& basis);

/// gpu::MapFrame on the device: the depth of receivers, and the light's box. Depends on mesh and light only.
class MapFrame final : public MapProduct {
 public:
  explicit MapFrame(const render::Device& device);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return frame_; }

 private:
  render::Buffer frame_;
};

}  // namespace penumbra::maps
