// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/compute_pass.hpp"

#include <cstdint>

namespace penumbra::maps {

/// Summed-area tables (Crow 1984) of images of unsigned integers: texel (x, y) becomes the sum of all texels (i, j), i
/// ≤ x, j ≤ y, modulo 2³². A box's sum is the signed sum of four texels, exact if it is less than 2³².
class SummedAreas {
 public:
  explicit SummedAreas(const render::Device& device);
  /// Records the sums of the first `images` images of size² texels in a buffer, in place.
  void record(render::Commands& commands, const render::Buffer& buffer, std::uint32_t images, std::uint32_t size) const;

 private:
  render::ComputePass pass_;
};

}  // namespace penumbra::maps
