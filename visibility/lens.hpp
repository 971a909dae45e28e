// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <cstdint>

namespace penumbra::visibility {

/// A thin lens, and the points of it that a picture's view samples use. A pixel has side × side view samples at each of
/// `moments` moments; each looks through a separate point. All of a pixel's points together are spread evenly over the
/// lens, in a different arrangement for each pixel. The points depend only on the members of this struct and the pixel.
struct Lens {
  double radius = 0, focus_distance = 1;  ///< both above 0
  std::uint32_t side = 1;                 ///< view samples of a pixel along each axis of the picture
  std::uint32_t moment = 0, moments = 1;  ///< the picture's number among those that are averaged

  /// Returns the lens point of a view sample, as distances to the right of and above the lens's middle.
  [[nodiscard]] glm::dvec2 point(std::uint32_t x, std::uint32_t y) const;

  bool operator==(const Lens&) const = default;
};

}  // namespace penumbra::visibility
