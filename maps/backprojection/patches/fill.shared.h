// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: constants of fill.glsl.
#ifdef __cplusplus
#pragma once
#include "maps/host/map_view.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kFillNone = 0, kFillEdges = 1, kFillDiagonal = 2, kFillShared = 3;
}  // namespace penumbra::maps::gpu
#else
#include "maps/host/map_view.shared.h"
const uint kFillNone = 0, kFillEdges = 1, kFillDiagonal = 2, kFillShared = 3;
#endif
