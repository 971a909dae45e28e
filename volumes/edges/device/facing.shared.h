// One struct, two languages (scalar layout): what a facing of a triangle is computed from. Lengths are in scene floats
// times a power of two.
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
  FLOAT3(slack);  // what n · g may be wrong by, for each unit of |g|; negative: no area
};

struct FacingPoint {
  FLOAT3(p);
  float slack;  // what underflow may add; very large: too far away for floats, ask the host
};

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
#undef FLOAT3
