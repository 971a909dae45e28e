// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: head of LightTable's buffer.
#ifdef __cplusplus
#pragma once
#include "maps/host/map_view.shared.h"
namespace penumbra::maps::gpu {
#endif

// Planar light in its basis. Followed by `corners` corners of its outline (a disk has none), then (width + 1)(height +
// 1) numbers, row by row: the fraction of the light in [0, x / width] x [0, y / height] of its bounding rectangle.
struct LightTableHead {
  vec2 lower, upper;  // the bounding rectangle
  float radius;       // of a disk, else 0
  float area;
  uint corners;
  uint width, height;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
