// Structs and constants, two languages: silhouette edges and what is drawn beside them. outer_map.hpp has the picture.
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
const uint kSheet = 0, kFirstEnd = 1, kSecondEnd = 2;  // parts of what is drawn beside an edge
#endif

// An edge in the light's basis, z > 0. With (a, b) = (x/z, y/z): the light's centre sees its penumbra beside it, from
// the edge along `outward`; `along` points from the first end to the second. Both are unit vectors.
#ifdef __cplusplus
struct OuterEdge {
  vec3 first, second;
  vec2 outward, along;
};
static_assert(sizeof(OuterEdge) == kOuterFloats * sizeof(float));
#endif

// outer_map.vert, outer_map.frag: a face. OpenGL lays out what follows a struct on the next multiple of 16 bytes.
struct OuterPush {
  vec3 row_x;  // clip.x = dot(row_x, d), likewise y and w: d in the light's basis, z > 0
  float near;
  vec3 row_y;
  float far;  // of the maps
  vec3 row_w;
  float width;  // cones: the light's radius; smoothies: how wide they are, 1 from the light's centre
  vec2 lower;   // of the face, and a texel's extent
  vec2 texel;
  uint size;
  uint first;      // texel of the face
  int axis;        // of the face: 0, 1, 2
  float sign;      // of a sideways face's axis, else 1
  uint smoothies;  // 0: cones
  uint filler_a, filler_b, filler_c;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_OUTER_MAP
