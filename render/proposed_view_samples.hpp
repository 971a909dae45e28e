// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/opengl/context.hpp"
#include "visibility/scene_floats.hpp"
#include "visibility/view_samples.hpp"

namespace penumbra::render {

/// Computes view samples with the other rasteriser: OpenGL proposes pixels for each triangle as VisibilityBuffer's
/// rasteriser does, and the host decides by visibility::cover, the smallest t, then the smallest rank
/// (visibility::ranks). Bit-identical to visibility::brute_force_view_samples, unless the rasteriser misses a pixel
/// that it has to propose.
visibility::ViewSamples proposed_view_samples(const opengl::Context& context, const visibility::SceneFloats& scene,
                                              const visibility::PinholeCamera& camera);

}  // namespace penumbra::render
