// SPDX-License-Identifier: Apache-2.0
// Width and height of a camera's picture: for a camera with its own aspect, the longer side is that of the scene's
// size.

#include "scenes/picture_size.hpp"

#include <algorithm>
#include <cmath>

namespace penumbra::scenes {

std::pair<std::uint32_t, std::uint32_t> picture_size(const Scene& scene, const Camera& camera) {
  if (!camera.aspect) return {scene.width, scene.height};
  const double longest = std::max(scene.width, scene.height), aspect = *camera.aspect;
  const auto pixels = [&](double share) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(longest * std::min(share, 1.0))));
  };
  return {pixels(aspect), pixels(1 / aspect)};
}

}  // namespace penumbra::scenes
