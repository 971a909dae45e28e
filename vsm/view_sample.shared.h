// SPDX-License-Identifier: Apache-2.0
// Push constants shared by C++ and GLSL (scalar layout): input of the view-sample passes. Lengths are in scene floats
// times a power of two, so that the float range fits scenes of any size.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::vsm::gpu {
using uint = std::uint32_t;
#define FLOAT3(name) float name[3]
#else
#define FLOAT3(name) vec3 name
#endif

struct ViewSamplePush {
  FLOAT3(center);  // the light: center + s·u + t·v, s and t in [−1, 1]
  FLOAT3(u);
  FLOAT3(v);
  float deviation;  // largest distance of a stored light sample from its place at (s, t)
  float reach;      // at least the largest magnitude of a coordinate in the scene
  uint two_sided;
  int light;                   // index of the light; triangles of its own body are transparent to it
  uint width;                  // pixels in a row
  uint first_row;              // first row of the tile in the stored view samples
  uint band_first, band_rows;  // the rows of the tile that this dispatch handles
  uint sample_count;
  uint rows, columns;  // size of rows and grid patterns
  uint shift_step;     // a row's shift in cells is (row · step) / 2¹⁶ modulo 1
  uint question_capacity, chunk_capacity;
  uint empty_tree;
  uint part_levels, part;  // find_leaves: handles only the part of the tree below one child of each of the first
                           // part_levels levels; `part` has the child's number, three bits for each level from the
                           // lowest. Part 0 also does work that is needed once
  uint closed_parts;       // bit k: part k, from 1, is separate from the light, and has dispensable triangles
};

struct ResolvePush {
  uint pixel_count;
  uint sample_count;
};

// A question that float arithmetic left open, for the exact predicates: whether `hider` hides `light_sample` from
// `pixel` (of the tile).
struct OpenQuestion {
  uint pixel;
  uint hider;         // a triangle, kCarrier or kAnyTriangle (engines/device/mask.shared.h)
  uint light_sample;  // a bit of the mask, or kAllSamples
};

const uint kAllSamples = 0xffffffffu;

#ifdef __cplusplus
}  // namespace penumbra::vsm::gpu
#endif
#undef FLOAT3
