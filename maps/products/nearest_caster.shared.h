// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of nearest_caster.comp.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct NearestPush {
  uint size;
  uint faces;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
