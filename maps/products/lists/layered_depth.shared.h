// Structs, two languages: of the shaders of layered_depth.cpp.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// One surface in the direction of a texel of the centre's maps.
struct LayerEntry {
  float t;      // depth along the face's axis, where the texel's own centre sees it
  float reach;  // how much the surface's depth changes within the texel: as far off it is still this surface
  uint weight;  // of the light samples that see it
  uint last;    // the last of them, counted from 1
};

// What one sample's texel brought to a texel of the centre's.
struct LayerNode {
  uint t;       // bits of the depth
  uint before;  // the node before, counted from 1
  float reach;
};

struct WarpPush {
  LightBasis basis;
  uint size;
  uint point;      // the sample whose map is warped
  uint first_map;  // its first face in the buffer of maps
  uint faces;      // of the centre's view; of one sample's
  uint sample_faces;
  uint node_capacity;
  float epsilon;
};

struct MergePush {
  uint texels;
  uint layers;  // entries a texel can have
  uint point;
  float epsilon;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
