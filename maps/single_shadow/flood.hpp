#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace penumbra::maps {

/// A pixel as a flood on the screen knows it.
struct FloodPixel {
  enum class State : std::uint8_t { nothing, lit, shaded };
  State state = State::nothing;
  glm::dvec2 seen{0};  ///< where the light's centre sees it, in (x/z, y/z)
  double height = 0;   ///< of the view sample over the light's plane
  double blocker = 0;  ///< of a shaded one, that of what shades it
};

struct FloodResult {
  std::vector<double> share;  ///< for each pixel, 0 … 1: how far through a penumbra it is; 0.5 on the hard border
  std::uint32_t passes = 0;   ///< a pixel each
};

/// Arvo et al. 2004: borders of the hard shadow between neighbouring pixels, grown a pixel at a time inward and outward
/// as far as penumbrae reach, each pixel with the border point that came to it, the nearest of its neighbours'.
/// `light`: the light's radius.
FloodResult flood(std::span<const FloodPixel> pixels, std::uint32_t width, double light);

}  // namespace penumbra::maps
