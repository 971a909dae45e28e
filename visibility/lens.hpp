#pragma once

#include <glm/vec2.hpp>

#include <cstdint>

namespace penumbra::visibility {

/// A thin lens, and how a picture's view samples share it out. A pixel has side × side of them at each of `moments`
/// moments; each looks through a point of its own. All of a pixel's points together are spread evenly over the lens,
/// every pixel's in another way. A function of the numbers here alone.
struct Lens {
  double radius = 0, focus_distance = 1;  ///< both above 0
  std::uint32_t side = 1;                 ///< view samples a pixel along each axis of the picture
  std::uint32_t moment = 0, moments = 1;  ///< the picture's place among those that are averaged

  /// Where the view sample looks through: right of and above the lens's middle.
  [[nodiscard]] glm::dvec2 point(std::uint32_t x, std::uint32_t y) const;

  bool operator==(const Lens&) const = default;
};

}  // namespace penumbra::visibility
