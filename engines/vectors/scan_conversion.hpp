// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/view_samples.hpp"

namespace penumbra::vectors {

/// Computes view samples by scan conversion on the processor, in double: bit-identical to
/// visibility::brute_force_view_samples and render::VisibilityBuffer. Uses all cores; triangles that contain no pixel's
/// centre are culled, a vector at a time, others are sorted into tiles of pixels, and each tile keeps its smallest t.
///
/// Time grows with triangles plus covered pixels; additional memory: 16 bytes for each pixel and lists of tiles, up to
/// 100 MB. Places of rays are taken to be right to a pixel: for a triangle so nearly edge-on that the signs of cover()
/// are rounding alone, pixels more than one pixel outside of the box of its projection are left out.
visibility::ViewSamples scan_view_samples(const visibility::SceneFloats& scene,
                                          const visibility::PinholeCamera& camera);

}  // namespace penumbra::vectors
