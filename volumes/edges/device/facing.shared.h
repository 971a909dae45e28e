// SPDX-License-Identifier: Apache-2.0
// Structs shared by C++ and GLSL (scalar layout): input of a triangle's facing. Lengths are in scene floats times a
// power of two.
#ifdef __cplusplus
#pragma once
namespace penumbra::volumes::gpu {
#define FLOAT3(name) float name[3]
#else
#define FLOAT3(name) vec3 name
#endif

struct FacingTriangle {
  FLOAT3(a);      // a corner
  FLOAT3(n);      // the normal, times a power of two
  FLOAT3(slack);  // error of n · g for each unit of |g|; negative: no area
};

struct FacingPoint {
  FLOAT3(p);
  float slack;  // error due to underflow; very large: too far away for floats, the host decides
};

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
#undef FLOAT3
