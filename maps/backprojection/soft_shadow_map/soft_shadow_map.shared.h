// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of the shaders of soft_shadow_map.cpp.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// One side of the light's plane: the map of the occluders and the map of the receivers, both from the light's centre.
// Windows are of tangents (x/z, y/z); z is the map's value times far.
struct SoftMapPush {
  vec2 occluder_lower, occluder_texel;  // border of the first texel, and a texel's width
  vec2 receiver_lower, receiver_texel;
  vec2 light_lower, light_upper;  // bounding rectangle of the light, in its basis
  float occluder_far, receiver_far;
  float nearest;   // depth of the nearest occluder to the light's plane
  float deepest;   // depth of the farthest receiver
  float bias;      // in texels of the occluder map
  uint depth_use;  // kDepthFirst ...
  uint occluder_size, receiver_size;
  uint occluder_first, receiver_first;  // first float in their buffers
  uint second_first;                    // first float of the surfaces behind the occluders, if depth_use needs them
  uint upright;                         // 1: the light is a rectangle along its basis, without texture
  uint half_floats;                     // 1: adds in 16-bit floats, as published
  uint first_row, last_row;             // of the map in the loop: some drivers end loops after 65,535 iterations
  uint later;                           // 1: keeps the smaller V of this pass and the previous ones
};

// Push constants of soft_shadow_map.comp after LookupPush. The receivers' windows are those of the view.
struct SoftLookupPush {
  uint size;
  uint linear;  // 1: between the four texels around; 0: the nearest one
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
