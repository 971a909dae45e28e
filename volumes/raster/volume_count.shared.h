// Structs written once for C++ and GLSL: faces of shadow volumes, view samples, push constants.
#ifdef __cplusplus
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
using glm::vec2;
using glm::vec3;
#define DOUBLE3(name) double name[3]
#else
#define DOUBLE3(name) f64vec3 name
#endif

/// |error| of a 3 × 3 determinant of differences, relative to the product of its rows' 1-norms (volumes/README.md,
/// Doubt): 2⁻⁴⁸.
const double kDeterminantError = 1.0 / 281474976710656.0;

/// A face of shadow volumes: a side (edge a b, k_e in weight), its fan at the far end (the same), or a cap (a, b, c).
struct VolumeFace {
  vec3 a, b, c;
  int weight;
  uint plane;       // of a cap
  vec2 corners[4];  // its screen box
};

struct VolumeReceiver {
  vec3 p;
  uint plane;  // of the carrier; kNotCounted: leave this pixel alone
};
const uint kNotCounted = 0xffffffffu;

struct VolumePush {
  DOUBLE3(eye);
  DOUBLE3(apex);  // the direction where all fans meet
  vec3 l;
  uint width;                 // of the whole picture
  uint first_row, row_count;  // the tile
};

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
#undef DOUBLE3
