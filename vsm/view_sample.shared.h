// One struct, two languages (scalar layout): what the view-sample passes are told. Lengths are in scene floats times a
// power of two, so that the float range fits scenes of any size.
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
  FLOAT3(center);              // the light: center + s·u + t·v, s and t in [−1, 1]
  FLOAT3(u);
  FLOAT3(v);
  float deviation;             // the farthest that a stored light sample lies from where (s, t) puts it
  float reach;                 // at least the largest coordinate, in size, of anything in the scene
  uint two_sided;
  int light;                   // triangles that are this light's body are transparent to it
  uint width;                  // pixels in a row
  uint first_row;              // of the tile in the stored view samples
  uint band_first, band_rows;  // the rows of the tile that this dispatch works on
  uint sample_count;
  uint rows, columns;          // rows and grid patterns
  uint shift_step;             // a row's shift in cells is (row · step) / 2¹⁶ modulo 1
  uint question_capacity, chunk_capacity;
  uint empty_tree;
  uint part_levels, part;      // find_leaves: of the tree only what lies below one child of each of so many levels; which
                               // child, three bits a level from the lowest. Part 0 does what is done once, too
  uint closed_parts;           // bit k: part k, from 1, is apart from the light, and has dispensable triangles
};

// Why a pass could not finish: what the device's loop limit cut off.
const uint kWalkCut = 1u, kTestCut = 2u;

struct ResolvePush {
  uint pixel_count;
  uint sample_count;
};

// A question that float arithmetic left open, for the exact predicates: does `triangle` hide `light_sample` from `pixel`
// (of the tile)?
struct OpenQuestion {
  uint pixel;
  uint triangle;               // or one of the two below
  uint light_sample;           // or kAllSamples
};

#ifdef __cplusplus
inline constexpr uint kCarrier = 0xfffffffeu;     // instead of a triangle: is the light sample above the horizon?
inline constexpr uint kWholePixel = 0xffffffffu;  // instead of a triangle: p is within rounding of the light's plane
inline constexpr uint kAllSamples = 0xffffffffu;
}  // namespace penumbra::vsm::gpu
#else
const uint kCarrier = 0xfffffffeu;
const uint kWholePixel = 0xffffffffu;
const uint kAllSamples = 0xffffffffu;
#endif
#undef FLOAT3
