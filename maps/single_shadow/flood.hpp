// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// Pixel of a flood on the screen.
struct FloodPixel {
  enum class State : std::uint8_t { nothing, lit, shaded };
  State state = State::nothing;
  glm::dvec2 seen{0};  ///< position as seen from the light's centre, in (x/z, y/z)
  double height = 0;   ///< of the view sample over the light's plane
  double blocker = 0;  ///< of a shaded pixel, height of its caster
};

struct FloodResult {
  std::vector<double> share;  ///< for each pixel, position in a penumbra, 0 … 1; 0.5 on the hard border
  std::uint32_t passes = 0;   ///< number of passes, each of one pixel
};

/// Grows borders of the hard shadow between neighbouring pixels, a pixel at a time, inward and outward to the extent of
/// penumbrae (Arvo et al. 2004); each pixel keeps the nearest of its neighbours' border points. `light`: the light's
/// radius.
FloodResult flood(std::span<const FloodPixel> pixels, std::uint32_t width, double light);

}  // namespace penumbra::maps
