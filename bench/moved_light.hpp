#pragma once

#include "scenes/scene.hpp"

namespace penumbra::bench {

/// A light in the frame after this one, which crosses its own width in a dozen frames: moved within its plane, a sphere
/// along x, a sun by as large a part of its angle (of half a degree, where it has none). Not of one in pieces
/// (std::logic_error).
scenes::LightShape moved_light(const scenes::LightShape& shape);

}  // namespace penumbra::bench
