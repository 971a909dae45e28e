// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/device.hpp"
#include "visibility/method.hpp"
#include "volumes/counters/depth_counters.hpp"

#include <cstdint>
#include <memory>

namespace penumbra::volumes {

struct PackedOptions {
  std::uint32_t counter_bits = 16;  ///< 6, 8 or 16
  bool as_published = false;
  bool keeps_counters = false;  ///< for read_counters, which must not be called otherwise
};

/// Makes variant=forest of `depth-complexity` (Forest, Barthe, Paulin 2008): a packed counter for each light sample;
/// silhouettes are those seen from the light's centre c, whose wedges are rasterised, once for each 32 light samples;
/// hard shadow volumes of c give the constant. docs/depth-complexity.md.
///
/// A counter is Σ σ_T over the triangles T that p→l meets, σ_T = 1 where p and c are on opposite sides of T, −1 where
/// they are on the same side, 0 where c is on its plane. So a pair counted as blocked is blocked; the result may only
/// be too bright, and only where p→l meets a triangle whose plane passes through c or between c and l.
///
/// Where counters may have overflowed, and where signs are in doubt, pairs are decided exactly; with `as_published` the
/// counters are used there, polluted by overflow from neighbouring bits. read_counters returns only counters of light
/// samples above the horizon.
std::unique_ptr<DepthCounters> make_packed_counters(const render::Device& device, const PackedOptions& options);

}  // namespace penumbra::volumes
