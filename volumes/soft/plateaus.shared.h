// SPDX-License-Identifier: Apache-2.0
// Constants shared by C++ and GLSL: plateaus.
#ifdef __cplusplus
#pragma once
namespace penumbra::volumes::gpu {
#endif

/// The part of an edge that is higher over the receiver's plane than this fraction of the light's height casts nothing
/// outward: there the disk that represents its penumbra is unbounded.
const double kHighest = 1.0 - 1.0 / 1048576.0;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
