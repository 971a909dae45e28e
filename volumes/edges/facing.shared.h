// One struct, two languages (scalar layout): what the facing passes read and write. Lengths are in scene floats times a
// power of two.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
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

// 32 triangles as one point sees them, some of which (the bits set in both) float arithmetic cannot decide.
struct UndecidedWord {
  uint word;  // its place in the bit planes
  uint front, back;
};

struct FacingPush {
  uint point_count;
  uint point_groups;  // workgroups that the points take
  uint first_word;    // of these triangles in the bit planes
  uint word_count;    // of these triangles
  uint capacity;      // of the list of undecided words
};

#ifdef __cplusplus
inline constexpr std::uint32_t kLanes = 64, kPointsPerLane = 8;
}  // namespace penumbra::volumes::gpu
#else
const uint kLanes = 64u, kPointsPerLane = 8;
#endif
#undef FLOAT3
