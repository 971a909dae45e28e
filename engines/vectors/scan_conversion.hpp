#pragma once

#include "visibility/view_samples.hpp"

namespace penumbra::vectors {

/// View samples by scan conversion on the processor, in double: the bits of visibility::brute_force_view_samples and of
/// render::VisibilityBuffer. All cores; triangles that hold no pixel's centre are left out, a vector at a time, others
/// are sorted into tiles of pixels, and each tile keeps its smallest t.
///
/// Time grows with triangles plus covered pixels; memory beside the scene: 16 bytes a pixel and lists of tiles, up to
/// 100 MB. The rays' places are trusted to a pixel: of a triangle so nearly edge-on that the signs of
/// cover() are rounding alone, pixels farther than one beside the box of its projection are left out.
visibility::ViewSamples scan_view_samples(const visibility::SceneFloats& scene,
                                          const visibility::PinholeCamera& camera);

}  // namespace penumbra::vectors
