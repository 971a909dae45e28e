// Constants written once for C++ and GLSL: plateaus.
#ifdef __cplusplus
#pragma once
namespace penumbra::volumes::gpu {
#endif

/// Of an edge what is higher over the receiver's plane than this share of the light's height casts nothing outward:
/// there the disk that stands for its penumbra has no end.
const double kHighest = 1.0 - 1.0 / 1048576.0;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
