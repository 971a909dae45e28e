// One struct, two languages: level_maps.comp's, and how wide a level is.
#ifndef PENUMBRA_MAPS_LEVEL_MAPS  // shaders include this in several ways
#define PENUMBRA_MAPS_LEVEL_MAPS
#ifdef __cplusplus
#pragma once
#include "maps/host/map_view.shared.h"
namespace penumbra::maps::gpu {
inline constexpr uint kFinestLevel = 0, kOneLevel = 1, kLevelsByBudget = 2;
inline constexpr uint kCoarsestLevel = 6;
#else
#include "maps/host/map_view.shared.h"
// Which levels are looked at: the maps themselves, one that is coarser, or what a budget says.
const uint kFinestLevel = 0, kOneLevel = 1, kLevelsByBudget = 2;
const uint kCoarsestLevel = 6;
#endif

struct LevelPush {
  uint size;   // of the maps
  uint level;  // a texel of the level is 2^level of theirs wide
  uint maps;   // faces of all layers
  uint start;  // where the level begins in the buffer
};

#ifdef __cplusplus
/// Texels on a side of a level.
constexpr uint level_size(uint size, uint level) {
  return ((size - 1) >> level) + 1;
}
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_LEVEL_MAPS
