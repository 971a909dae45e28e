// SPDX-License-Identifier: Apache-2.0
// Structs shared by C++ and GLSL: footprints of penumbra wedges, view samples, push constants.
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

/// A silhouette edge a b with multiplicity `weight` (VolumeEdge), and the screen region of its wedge.
struct WedgeFace {
  vec3 a, b;
  int weight;
  uint number;  // index of the edge in LightWedges
  uint corner_count;
  vec2 corners[8];
};

struct WedgeReceiver {
  vec3 p;
  uint counted;  // 0: skip this pixel
};

/// The light's frame. A point x of its plane has the coordinates (u_dual · (x − c), v_dual · (x − c)): a rectangle is
/// [−1, 1]², a disk the unit disk. n has the direction of u × v and any length.
struct WedgePush {
  DOUBLE3(c);
  DOUBLE3(u_dual);
  DOUBLE3(v_dual);
  DOUBLE3(n);
  uint width;                 // width of the whole picture
  uint first_row, row_count;  // the tile
  uint texels;                // size of a texture: width, and height · 2¹⁶
};

/// Sums are integer multiples of 2⁻³² of the light, in 64 bits. A term is off by 2⁻³³: 2¹⁶ of them by less than 10⁻⁵.
/// Each is at most |k| lights, and all |k| add up to less than 3 · 2²⁸ (VolumeCount): no sum overflows 64 bits.
const double kSumUnit = 1.0 / 4294967296.0;

const uint kRectangle = 0, kDisk = 1;

/// Two points of the light other than its centre, in its frame, for votes on the number of layers (soft-volume).
const uint kVoters = 2;
#ifdef __cplusplus
inline constexpr double kVoterAt[kVoters][2] = {{0.40625, 0.28125}, {-0.28125, 0.34375}};
#else
const dvec2 kVoterAt[kVoters] = dvec2[kVoters](dvec2(0.40625LF, 0.28125LF), dvec2(-0.28125LF, 0.34375LF));
#endif

/// How soft_volume.frag finds the share of the light on one side of an edge: as an area in closed form; from the
/// precomputed table of the option coverage=table; or, for a textured light, as a sum over texels.
const uint kArea = 0, kTable = 1, kTexture = 2;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
#undef DOUBLE3
