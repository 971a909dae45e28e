// Structs, two languages: of the shaders of soft_shadow_map.cpp.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// One side of the light's plane: the map of the occluders and that of the receivers, both from the light's centre.
// Windows are of tangents (x/z, y/z); z is what a map holds, times far.
struct SoftMapPush {
  vec2 occluder_lower, occluder_texel;  // where the first texel begins, and a texel's width
  vec2 receiver_lower, receiver_texel;
  vec2 light_lower, light_upper;  // the light's bounding rectangle, in its basis
  float occluder_far, receiver_far;
  float nearest;   // no occluder is nearer to the light's plane
  float deepest;   // and no receiver farther
  float bias;      // in the occluder map's texels
  uint depth_use;  // kDepthFirst ...
  uint occluder_size, receiver_size;
  uint occluder_first, receiver_first;  // in their buffers, in floats
  uint second_first;                    // of the surfaces behind the occluders, if depth_use asks
  uint upright;                         // 1: the light is a rectangle along its basis, without texture
  uint half_floats;                     // 1: adds in 16-bit floats, as blending did
  uint first_row, last_row;             // of the map that is looped over: some drivers end loops after 65,535 turns
  uint later;                           // 1: keeps the smaller V of this pass and those before
};

// soft_shadow_map.comp, behind LookupPush. The receivers' windows are the view's.
struct SoftLookupPush {
  uint size;
  uint linear;  // 1: between the four texels around; 0: the nearest one
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
