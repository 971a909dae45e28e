// SPDX-License-Identifier: Apache-2.0
// Structs shared by C++ and GLSL: faces of shadow volumes, view samples, push constants.
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

/// A face of shadow volumes: a side (edge a b, k_e in weight), its fan at the far end (the same fields), or a cap (a,
/// b, c).
struct VolumeFace {
  vec3 a, b, c;
  int weight;
  uint plane;       // plane of a cap
  uint part;        // index of its VolumePart, if there are parts
  vec2 corners[4];  // its screen box
};

/// Volumes that are counted together in the same direction; n is the axis and x is relative to l.
struct VolumePart {
  DOUBLE3(axis);
  double lower, upper;  // the remaining part of the volumes: lower < n · x < upper
  DOUBLE3(barrier);     // with kToggles: faces count between the eye and p where barrier · p > 0, else beyond p
  uint bounds;          // valid bounds: kHasLower, kHasUpper, kToggles
  uint unused;
};
const uint kHasLower = 1, kHasUpper = 2, kToggles = 4;

/// Bit of the word that counts a pixel's changes.
const uint kDoubtBit = 0x80000000u;

struct VolumeReceiver {
  vec3 p;
  uint plane;  // plane of the carrier; kNotCounted: skip this pixel
};
const uint kNotCounted = 0xffffffffu;

struct VolumePush {
  DOUBLE3(eye);
  DOUBLE3(apex);  // the direction where all fans meet
  vec3 l;
  uint width;                 // width of the whole picture
  uint first_row, row_count;  // the tile
};

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
#undef DOUBLE3
