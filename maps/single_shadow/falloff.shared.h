// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: constants of falloff.glsl.
#ifndef PENUMBRA_MAPS_FALLOFF
#define PENUMBRA_MAPS_FALLOFF
#ifdef __cplusplus
#pragma once
#include "maps/host/map_view.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kFalloffLinear = 0, kFalloffCubic = 1, kFalloffSine = 2;
}  // namespace penumbra::maps::gpu
#else
const uint kFalloffLinear = 0, kFalloffCubic = 1, kFalloffSine = 2;
#endif
#endif  // PENUMBRA_MAPS_FALLOFF
