#pragma once

#include "maps/backprojection/contours/contour.shared.h"
#include "maps/host/map_method.hpp"

#include <glm/vec3.hpp>

#include <vector>

namespace penumbra::maps {

/// A planar light as contours cut it: a header, and of a polygon for each corner, counter-clockwise, its two
/// coordinates and the share of the light between the rays from the centroid through the first corner and through it.
struct ContourLightData {
  gpu::ContourLight head;
  std::vector<glm::vec3> corners;
};
ContourLightData contour_light(const visibility::Light& light, const LightBasis& basis);

/// contour_light on the device; radial.glsl reads it.
class ContourLightProduct final : public MapProduct {
 public:
  explicit ContourLightProduct(const render::Device& device) : device_(&device) {}
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return *light_; }

 private:
  const render::Device* device_;
  std::unique_ptr<render::Buffer> light_;
};

/// The buffer of another product, where a look-up asks one for two purposes. `other` must outlive it.
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
