// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of the shaders of penumbra_events.cpp.
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
  uint capacity;     // largest number of events of a texel
  uint first_point;  // first of the samples whose maps are traversed
  uint first_map;    // index, counted in faces, at which the maps of sample first_point begin in the buffer
  uint point_count;
  uint sample_faces;  // of one sample
  vec2 nearest;       // depth of the nearest caster to the light's plane, on either side
};

struct NearestDepthsPush {
  uint size;
  uint first_point;  // as in EventsPush
  uint first_map;
  uint point_count;
  uint sample_faces;
};

struct CompressPush {
  uint texel_count;
  uint capacity;
  uint total;      // sum of all weights
  uint tolerance;  // twice the permitted error of V (PenumbraEvents' `bound`), as a sum of weights
};

struct CopyStepsPush {
  uint texel_count;
  uint capacity;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
