// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

namespace penumbra::bench {

/// Returns the light in the next frame, moved so that the light crosses its own width in twelve frames: within its
/// plane, a sphere along x, a sun by the same fraction of its angle (of half a degree, if it has none). Throws
/// std::logic_error for a light in pieces.
scenes::LightShape moved_light(const scenes::LightShape& shape);

}  // namespace penumbra::bench
