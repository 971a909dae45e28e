// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of summed_areas.comp.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct SummedAreasPush {
  uint size;     // of an image, texels on a side
  uint lines;    // of all images: rows or columns
  uint columns;  // 0: sums run along rows, 1: along columns
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
