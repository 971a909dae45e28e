// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: push constants of deep_penumbra.comp after LookupPush.
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

struct DeepPenumbraPush {
  uint sample_count;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
