// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "maps/products/lists/sample_maps.hpp"
#include "render/compute_pass.hpp"

namespace penumbra::maps {

/// V as a function of depth for each texel of the light's centre's maps (St-Amour, Paquette and Poulin 2005): lists of
/// steps. The ray through a texel's centre is at t · direction, with `direction` of length one along the face's axis.
///
/// The buffer holds T + 1 words (where the list of each of the T texels begins, and where the last list ends), and
/// then the steps: the bits of t, and the bits of V from there to the next step. Before the first step V is 1.
class PenumbraEvents final : public MapProduct {
 public:
  /// `bound`: largest permitted error of V, 0 … 0.5.
  PenumbraEvents(const render::Device& device, double bound);
  void make(const MapSource& source) override;
  void record(render::Commands& /*commands*/, const MapSet& /*maps*/) override {}
  [[nodiscard]] const render::Buffer& buffer() const override { return *lists_; }
  [[nodiscard]] std::uint64_t memory_bytes() const override;

 private:
  /// Finds the smallest depth in each light sample's maps.
  void find_nearest(const MapSource& source);
  /// Sorts, sums and compresses a band's events; returns the number of steps of each texel.
  std::vector<std::uint32_t> compress(const MapSource& source, std::uint32_t texels, std::uint32_t capacity);
  /// Returns a band's steps, texel by texel.
  std::vector<glm::uvec2> gather(const MapSource& source, std::span<const std::uint32_t> counts,
                                 std::uint32_t capacity);

  const render::Device* device_;
  double bound_;
  SampleMaps samples_;
  render::ComputePass find_nearest_, walk_, compress_, copy_;
  std::unique_ptr<render::Buffer> centre_, nearest_, events_, counts_, most_, offsets_, steps_, lists_;
};

}  // namespace penumbra::maps
