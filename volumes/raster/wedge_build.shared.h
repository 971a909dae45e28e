// SPDX-License-Identifier: Apache-2.0
// Structs shared by C++ and GLSL (scalar layout): penumbra wedges that the device builds.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
#define DOUBLE3(name) double name[3]
#else
#define DOUBLE3(name) f64vec3 name
#endif

const uint kBuiltPlanes = 4;  // front, back, and one at either end

/// Coefficients of a Plane.
struct BuiltPlane {
  double a, b, c, d;
};

struct BuiltWedge {
  BuiltPlane planes[kBuiltPlanes];
  uint proved;  // 0: the host must build it
  uint unused;
};

struct WedgeBuildPush {
  DOUBLE3(center);
  uint first;  // first of the silhouettes
  uint count;
  uint corner_count;  // corners of the light's hull
  uint unused;
};

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
#undef DOUBLE3
