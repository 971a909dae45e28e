// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of level_maps.comp, and the width of a level.
#ifndef PENUMBRA_MAPS_LEVEL_MAPS  // included more than once by shaders, hence an include guard in place of #pragma once
#define PENUMBRA_MAPS_LEVEL_MAPS
#ifdef __cplusplus
#pragma once
#include "maps/host/map_view.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kFinestLevel = 0, kOneLevel = 1, kLevelsByBudget = 2;
inline constexpr uint kCoarsestLevel = 6;
#else
#include "maps/host/map_view.shared.h"
// Levels in use: the maps themselves, one coarser level, or a level chosen by a budget.
const uint kFinestLevel = 0, kOneLevel = 1, kLevelsByBudget = 2;
const uint kCoarsestLevel = 6;
#endif

struct LevelPush {
  uint size;   // of the maps, in texels
  uint level;  // a texel of the level is 2^level texels of the maps wide
  uint maps;   // number of faces of all layers
  uint start;  // first texel of the level in the buffer
};

#ifdef __cplusplus
/// Returns the number of texels on a side of a level.
constexpr uint level_size(uint size, uint level) {
  return ((size - 1) >> level) + 1;
}
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_LEVEL_MAPS
