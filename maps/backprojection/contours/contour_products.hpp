// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/backprojection/contours/contour.shared.h"
#include "maps/host/map_method.hpp"

#include <glm/vec3.hpp>

#include <vector>

namespace penumbra::maps {

/// Planar light in the form used for clipping contours: a header and, for each corner of a polygon, counter-clockwise,
/// its two coordinates and the fraction of the light between the ray from the centroid through the first corner and the
/// ray through this corner. A textured rectangle has its texture's table in place of corners (radiance.glsl), stored in
/// groups of three numbers.
struct ContourLightData {
  gpu::ContourLight head;
  std::vector<glm::vec3> corners;
};
ContourLightData contour_light(const visibility::Light& light, const LightBasis& basis);

/// Buffer of contour_light on the device, read by radial.glsl.
class ContourLightProduct final : public MapProduct {
 public:
  explicit ContourLightProduct(const render::Device& device) : device_(&device) {}
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *light_; }

 private:
  const render::Device* device_;
  std::unique_ptr<render::Buffer> light_;
};

/// Buffer of another product, for a look-up that binds one product twice. `other` must outlive this object.
class SameProduct final : public MapProduct {
 public:
  explicit SameProduct(const MapProduct& other) : other_(&other) {}
  void record(render::Commands& /*commands*/, const MapSet& /*maps*/) override {}
  [[nodiscard]] const render::Buffer& buffer() const override { return other_->buffer(); }
  [[nodiscard]] std::uint64_t memory_bytes() const override { return 0; }

 private:
  const MapProduct* other_;
};

}  // namespace penumbra::maps
