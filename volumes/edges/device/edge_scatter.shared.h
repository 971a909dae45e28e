// SPDX-License-Identifier: Apache-2.0
// Push constants shared by C++ and GLSL (scalar layout): input of the edge-scatter passes. Lengths are in scene floats
// times a power of two, so that the float range fits scenes of any size.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace penumbra::volumes::gpu {
using uint = std::uint32_t;
#define FLOAT3(name) float name[3]
#else
#define FLOAT3(name) vec3 name
#endif

struct ScatterPush {
  FLOAT3(center);  // the light: center + s·u + t·v, s and t in [−1, 1]
  FLOAT3(u);
  FLOAT3(v);
  float deviation;  // largest distance of a stored light sample from its place at (s, t)
  float reach;      // at least the largest magnitude of a coordinate in the scene
  float cut_reach;  // 4 · reach where edges were cut at the light's plane, else 0
  float side;       // +1: handles view samples on the side that u × v points to; −1: those on the other side
  uint keeps_rest;  // leaves view samples on the other side unchanged: another dispatch handles them
  uint light;       // index of the light; triangles of its own body are transparent to it
  uint width;       // pixels in a row
  uint first_row, row_count;  // the band in the stored view samples
  uint first_pixel;           // first pixel of the band in the tile
  uint rows, columns;         // of light samples; if these are not in rows, of cells of the light's frame
  uint shift_step;            // a row's shift in cells is (row · step) / 2¹⁶ modulo 1
  uint list_capacity;         // in words
  uint question_capacity;
  uint edge_depth, triangle_depth;  // levels of the hierarchies; 0: empty
  uint edge_root;                   // index of the root of the hierarchy of edges
  uint near_plane;                  // something is close to the light's plane: the host decides view samples close to
                                    // the plane
  uint part_levels, part;  // find_edges: handles only the part of both hierarchies below one child of each of the first
                           // part_levels levels; `part` has the child's number, three bits for each level from the
                           // lowest
  uint touched_low, touched_high;  // light rows with samples that some triangle touches; for more than 64 rows, or
                                   // without rows: all or none
};

// A question about light samples of a pixel (of the tile) that float arithmetic left open: light rows, where bit i of
// (low, high) is row first_row + i; and up to two more light samples, row · columns + column.
struct RowQuestion {
  uint pixel;  // | kWholePixel: all rows of the band, none of which is in the mask yet
  uint first_row;
  uint low, high;
  uint sample_1, sample_2;  // or kNoSample
};

const uint kNoSample = 0xffffffffu;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
#undef FLOAT3
