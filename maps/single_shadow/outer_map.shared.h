// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: silhouette edges and the triangles drawn beside them. outer_map.hpp describes them.
#ifndef PENUMBRA_MAPS_OUTER_MAP
#define PENUMBRA_MAPS_OUTER_MAP
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
inline constexpr uint kOuterFan = 8, kOuterVertices = 6 + 2 * 3 * kOuterFan, kOuterFloats = 10;
inline constexpr uint kSheet = 0, kFirstEnd = 1, kSecondEnd = 2;
#else
const uint kOuterFan = 8;                              // triangles around an end, over a quarter of a turn or more
const uint kOuterVertices = 6 + 2 * 3 * kOuterFan;     // of an edge
const uint kOuterFloats = 10;                          // of an edge
const uint kSheet = 0, kFirstEnd = 1, kSecondEnd = 2;  // parts drawn beside an edge
#endif

// Edge in the light's basis, z > 0. With (a, b) = (x/z, y/z): as seen from the light's centre, the penumbra extends
// from the edge along `outward`; `along` points from the first end to the second. Both are unit vectors.
#ifdef __cplusplus
struct OuterEdge {
  vec3 first, second;
  vec2 outward, along;
};
static_assert(sizeof(OuterEdge) == kOuterFloats * sizeof(float));
#endif

// Push constants of outer_map.vert and outer_map.frag: a face. OpenGL aligns the member after a struct to the next
// multiple of 16 bytes.
struct OuterPush {
  vec3 row_x;  // clip.x = dot(row_x, d), y and w in the same form: d in the light's basis, z > 0
  float near;
  vec3 row_y;
  float far;  // of the maps
  vec3 row_w;
  float width;  // cones: the light's radius; smoothies: their width at distance 1 from the light's centre
  vec2 lower;   // of the face, and a texel's extent
  vec2 texel;
  uint size;
  uint first;      // first texel of the face
  int axis;        // of the face: 0, 1, 2
  float sign;      // of a sideways face's axis, else 1
  uint smoothies;  // 0: cones
  uint filler_a, filler_b, filler_c;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_OUTER_MAP
