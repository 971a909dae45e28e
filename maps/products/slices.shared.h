// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: light-space slices. slices.hpp describes them.
#ifndef PENUMBRA_MAPS_SLICES
#define PENUMBRA_MAPS_SLICES
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
inline constexpr uint kMostSlices = 32;
#else
const uint kMostSlices = 32;  // bits of a word
#endif

// Heights are distances from the light's plane. A surface is in the first slice whose limit is not exceeded.
struct SlicePlanes {
  uint count;
  float limit[2][kMostSlices];  // of each slice, where the light's normal points and behind
  float plane[2][kMostSlices];  // plane to which a slice's surfaces are moved
};

// Push constants of slices.frag, after those of caster.vert.
struct SlicesPush {
  CasterPush face;
  uint size;      // of a face
  uint first;     // first texel of the face
  uint side;      // of the light's plane
  uint sideways;  // the face's rows run along the light's normal
};

// Push constants of slices_moved.comp.
struct MovedPush {
  uint size;
  uint faces;
  uint depth_use;  // kDepthSecond ...
  float bias;      // in texels
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_SLICES
