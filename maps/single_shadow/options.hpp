// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/single_shadow/falloff.shared.h"
#include "visibility/method_options.hpp"

#include <cstdint>

namespace penumbra::maps {

/// Returns the option `falloff`, the profile of V through a penumbra.
constexpr visibility::ChoiceOption<std::uint32_t, 3> falloff_option(std::uint32_t otherwise) {
  return {"falloff",
          {{"linear", gpu::kFalloffLinear}, {"cubic", gpu::kFalloffCubic}, {"sine", gpu::kFalloffSine}},
          otherwise,
          "function by which V rises through a penumbra: as for a rectangle along its side, Parker's polynomial, or "
          "Parker's sine"};
}

/// Search radius on the map: some drivers for processors end loops after 65,535 iterations, and a circle of 140 texels
/// has 61,529.
inline constexpr visibility::IntegerOption kSearchRadius{
    "radius", 1, 140, 64, "largest radius of the search, in texels around the view sample's own"};

}  // namespace penumbra::maps
