// One layout, two languages: what rasterisers need to know of surfaces with holes (alphaMode MASK). holes.hpp has the
// picture.
#ifndef PENUMBRA_MAPS_HOLES
#define PENUMBRA_MAPS_HOLES
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::maps::gpu {
using uint = std::uint32_t;
inline constexpr uint kPlaceWords = 5, kSurfaceWords = 261;
inline constexpr uint kRepeatTexels = 0, kMirrorTexels = 1, kClampTexels = 2;
}  // namespace penumbra::maps::gpu
#else
// Words of a corner: s, t and the vertex alpha times a weight, the weight itself (floats), and the number of its
// surface.
const uint kPlaceWords = 5;
// Words of a surface: where the picture's texels begin, in words; its width (0: there is no picture) and height; how s
// and t wrap; then for each texel the least vertex alpha with which something is there (floats; more than 1: never).
const uint kSurfaceWords = 261;
const uint kRepeatTexels = 0, kMirrorTexels = 1, kClampTexels = 2;
#endif
#endif  // PENUMBRA_MAPS_HOLES
