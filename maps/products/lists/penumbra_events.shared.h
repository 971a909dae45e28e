// Structs, two languages: of the shaders of penumbra_events.cpp, and what a look-up reads of them.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct EventsPush {
  LightBasis basis;
  uint size;
  uint faces;        // of the centre's view
  uint first_texel;  // of the band
  uint texel_count;
  uint capacity;     // events a texel can have
  uint first_point;  // of the samples whose maps are walked
  uint first_map;    // of the first of them, in the buffer of maps, in faces
  uint point_count;
  uint sample_faces;  // of one sample
  vec2 nearest;       // no caster is nearer to the light's plane than this, on either side
};

struct CompressPush {
  uint texel_count;
  uint capacity;
  uint total;      // of all weights
  uint tolerance;  // twice the bound, in weights
};

struct CopyStepsPush {
  uint texel_count;
  uint capacity;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
