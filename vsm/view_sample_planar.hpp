#pragma once

#include "visibility/method.hpp"

#include <memory>

namespace penumbra::vsm {

/// `view-sample-planar` (Eisemann and Décoret 2007): footprints of triangles on planar receivers, or on a height field,
/// and left-sample maps. Planar lights and suns. With lookup=exact every bit is the truth of its pair, with
/// lookup=nearest what the map says. On the processor. docs/view-sample-planar.md.
std::unique_ptr<visibility::Method> make_view_sample_planar(const visibility::MethodOptions& options);

}  // namespace penumbra::vsm
