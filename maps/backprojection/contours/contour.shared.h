// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of contour.comp after LookupPush, and the contents of its products' buffers.
#include "maps/host/map_view.shared.h"
#ifndef PENUMBRA_MAPS_CONTOUR  // included more than once by shaders, hence an include guard in place of #pragma once
#define PENUMBRA_MAPS_CONTOUR
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
inline constexpr uint kFlat = 0, kHierarchy = 1, kMinMax = 2;
inline constexpr uint kMostPacketPixels = 64;
inline constexpr uint kContourWhole = 1u << 22;
inline constexpr uint kWorkCounts = 8;
inline constexpr uint kTrivialPackets = 6;
#else
const uint kFlat = 0, kHierarchy = 1, kMinMax = 2;
const uint kMostPacketPixels = 64;
// Units of the light's area in which areas are added: a unit is the rounding of an area in float, and sums of up to 512
// lights on either side of 0 fit.
const int kContourWhole = 1 << 22;
const uint kWorkCounts = 8;
const uint kTrivialPackets = 6;  // index in WorkNumbers
#endif

struct ContourPush {
  uint packet_width, packet_height;  // pixels; 1 x 1: no packets
  uint traversal;                    // kFlat ...
  uint level, budget, blend;         // levels.glsl
  float divergence;                  // a packet is split if its probability of pixels with different contours is
                                     // greater
};

// The light in the form used for clipping edges, in the light's basis.
struct ContourLight {
  vec2 lower, upper;   // bounding rectangle of the light
  vec2 to_unit_x;      // a light point s is (dot(to_unit_x, s), dot(to_unit_y, s)) in [-1, 1]^2 for a rectangle, on a
  vec2 to_unit_y;      // disk of radius 1 for a disk or ellipse; a polygon keeps its own coordinates
  uint corners;        // number of corners of a polygon: (x, y, fraction of the light swept up to the corner) each; 0:
                       // a rectangle
  uint disk;           // 1: a disk or an ellipse
  float inverse_area;  // inverse of a polygon's area
  uint texture_width;  // texels of a rectangle's texture, whose table follows (radiance.glsl); 0: no texture
  uint texture_height;
};

// Counters of the work, in the order of WorkCounts.
struct WorkNumbers {
  uint nodes, cells, edges, shared_packets, parted, diverged, trivial, kernel_cells;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_CONTOUR
