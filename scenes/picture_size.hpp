#pragma once

#include "scenes/scene.hpp"

#include <cstdint>
#include <utility>

namespace penumbra::scenes {

/// Width and height in pixels of what a camera sees: the scene's, in the shape that the camera says; then the longer
/// side is the scene's.
std::pair<std::uint32_t, std::uint32_t> picture_size(const Scene& scene, const Camera& camera);

}  // namespace penumbra::scenes
