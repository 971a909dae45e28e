// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "render/compute_pass.hpp"

#include <optional>

namespace penumbra::maps {

/// Smallest distance from the light's plane of all surfaces in the maps of the light's centre: two floats, for the side
/// where its normal points and for the other; infinite where the maps of a side are empty.
class NearestCaster final : public MapProduct {
 public:
  explicit NearestCaster(const render::Device& device);
  void record(render::Commands& commands, const MapSet& maps) override;
  [[nodiscard]] const render::Buffer& buffer() const override { return nearest_; }
  [[nodiscard]] bool leaves_triangles() const override { return true; }

 private:
  const render::Device* device_;
  render::ComputePass pass_;
  std::optional<render::ComputePass> fitted_;  ///< for MapSet::face_table
  render::Buffer nearest_;
};

}  // namespace penumbra::maps
