// One struct, two languages: what contour.comp has behind LookupPush, and what its products hold.
#include "maps/host/map_view.shared.h"
#ifndef PENUMBRA_MAPS_CONTOUR  // shaders include this in several ways
#define PENUMBRA_MAPS_CONTOUR
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
inline constexpr uint kFlat = 0, kHierarchy = 1, kMinMax = 2;
inline constexpr uint kMostPacketPixels = 64;
inline constexpr uint kContourWhole = 1u << 22;
inline constexpr uint kWorkCounts = 8;
#else
const uint kFlat = 0, kHierarchy = 1, kMinMax = 2;
const uint kMostPacketPixels = 64;
// The light's area, in the parts that areas are added up in: a part is a float's rounding of an area, and sums of up to
// 512 lights on either side of 0 fit.
const int kContourWhole = 1 << 22;
const uint kWorkCounts = 8;
#endif

struct ContourPush {
  uint packet_width, packet_height;  // pixels; 1 x 1: no packets
  uint traversal;                    // kFlat ...
  uint level, budget, blend;         // levels.glsl
  float divergence;                  // a packet more likely than this to have pixels with different contours is parted
};

// The light as contours cut it, in its basis.
struct ContourLight {
  vec2 lower, upper;   // its bounding rectangle
  vec2 to_unit_x;      // a light point s is (dot(to_unit_x, s), dot(to_unit_y, s)) in [-1, 1]^2 of a rectangle, on a
  vec2 to_unit_y;      // disk of radius 1; a polygon's are its own coordinates
  uint corners;        // of a polygon: (x, y, share of the light swept up to it) each; 0: a rectangle
  uint disk;           // 1: a disk or an ellipse
  float inverse_area;  // of a polygon
};

// What is counted of the work, and in this order by WorkCounts.
struct WorkNumbers {
  uint nodes, cells, edges, shared_packets, parted, diverged, trivial, kernel_cells;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_CONTOUR
