// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

#include <cstdint>
#include <utility>

namespace penumbra::scenes {

/// Returns width and height in pixels of a camera's picture: the scene's size, or, if the camera has an aspect, that
/// shape with the scene's longer side.
std::pair<std::uint32_t, std::uint32_t> picture_size(const Scene& scene, const Camera& camera);

}  // namespace penumbra::scenes
