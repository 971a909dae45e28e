// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants and buffers of the shaders of layered_depth.cpp.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// Surface in the direction of a texel of the centre's maps.
struct LayerEntry {
  float t;      // depth along the face's axis, at the texel's own centre
  float reach;  // change of the surface's depth within the texel: a depth this far off is still this surface
  uint weight;  // total weight of the light samples that see the surface
  uint last;    // index of the last of these samples, counted from 1
};

// Contribution of one texel of a sample to a texel of the centre.
struct LayerNode {
  uint t;       // bits of the depth
  uint before;  // the previous node, counted from 1
  float reach;
};

struct WarpPush {
  LightBasis basis;
  uint size;
  uint point;      // the sample whose map is warped
  uint first_map;  // first face of the sample in the buffer of maps
  uint faces;      // number of faces: of the centre's view; of one sample's
  uint sample_faces;
  uint node_capacity;
  float epsilon;
};

struct MergePush {
  uint texels;
  uint layers;  // largest number of entries of a texel
  uint point;
  float epsilon;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
