// One struct, two languages: level_maps.comp's, and how wide a level is.
#ifdef __cplusplus
#pragma once
#include "maps/host/map_view.shared.h"
namespace penumbra::maps::gpu {
#else
#include "maps/host/map_view.shared.h"
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
