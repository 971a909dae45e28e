// One struct, two languages (scalar layout): what the edge-scatter passes are told. Lengths are in scene floats times a
// power of two, so that the float range fits scenes of any size.
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
  float deviation;            // the farthest that a stored light sample lies from where (s, t) puts it
  float reach;                // at least the largest coordinate, in size, of anything in the scene
  float cut_reach;            // 4 · reach where edges were cut at the light's plane, else 0
  float side;                 // +1: view samples where u × v points; −1: behind
  uint keeps_rest;            // leave view samples on the other side alone: another dispatch has them
  uint light;                 // triangles that are this light's body are transparent to it
  uint width;                 // pixels in a row
  uint first_row, row_count;  // of the band in the stored view samples
  uint first_pixel;           // of the band in the tile, whose masks and questions these are
  uint rows, columns;         // of light samples; of those in no rows, cells of the light's frame
  uint shift_step;            // a row's shift in cells is (row · step) / 2¹⁶ modulo 1
  uint list_capacity;         // words
  uint question_capacity;
  uint edge_depth, triangle_depth;  // levels of the hierarchies; 0: empty
  uint edge_root;                   // node that the hierarchy of edges begins at
  uint near_plane;                  // something is near the light's plane: view samples close to that are for the host
  uint part_levels, part;  // find_edges: of both hierarchies only what lies below one child of each of so many levels;
                           // which child, three bits a level from the lowest
  uint touched_low, touched_high;  // light rows with samples that something touches; of more than 64 rows, or where
                                   // there are none: all or none
};

// What float arithmetic left open of a pixel (of the tile): light rows, bit i of (low, high) is row first_row + i; and
// up to two more light samples, row · columns + column.
struct RowQuestion {
  uint pixel;  // | kWholePixel: all rows of the band, and nothing of it is in the mask yet
  uint first_row;
  uint low, high;
  uint sample_1, sample_2;  // or kNoSample
};

const uint kNoSample = 0xffffffffu;

#ifdef __cplusplus
}  // namespace penumbra::volumes::gpu
#endif
#undef FLOAT3
