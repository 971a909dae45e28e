// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: layout of the data of surfaces with holes (alphaMode MASK) for rasterisers. holes.hpp
// describes the pictures.
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
// Words of a corner: s, t and the vertex alpha times a weight, the weight itself (floats), and the index of the
// surface.
const uint kPlaceWords = 5;
// Words of a surface: first word of the picture's texels; the picture's width (0: no picture) and height; wrap modes of
// s and t; then for each texel the least vertex alpha at which the surface is solid (floats; more than 1: never).
const uint kSurfaceWords = 261;
const uint kRepeatTexels = 0, kMirrorTexels = 1, kClampTexels = 2;
#endif
#endif  // PENUMBRA_MAPS_HOLES
