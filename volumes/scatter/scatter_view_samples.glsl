// SPDX-License-Identifier: Apache-2.0
// Shared by scatter_edges.comp and scatter_points.comp: their inputs, and a lane's data about its view sample.

layout(constant_id = 2) const uint kGroupWidth = 4;       // pixels; the group's height is lanes / width
// Constants 3 and 4 are in scatter_rows.glsl and scatter_points.glsl.
layout(constant_id = 5) const uint kHistogramWords = 64;  // words for each lane

// Edge records (EdgeTexels), one texel buffer for each member: (a, plane 1), (b, plane 2), (n 1), (anchor 1), (n 2),
// (anchor 2).
layout(binding = 3) uniform usamplerBuffer record_a;
layout(binding = 4) uniform usamplerBuffer record_b;
layout(binding = 5) uniform usamplerBuffer record_n1;
layout(binding = 6) uniform usamplerBuffer record_anchor1;
layout(binding = 7) uniform usamplerBuffer record_n2;
layout(binding = 8) uniform usamplerBuffer record_anchor2;
// Triangles, one texel buffer for each corner: (a, triangle), (b, plane), (c, light whose body the triangle belongs
// to).
layout(binding = 9) uniform usamplerBuffer corner_a;
layout(binding = 10) uniform usamplerBuffer corner_b;
layout(binding = 11) uniform usamplerBuffer corner_c;
layout(scalar, binding = 12) buffer Masks { uint masks[]; };    // visible light samples
layout(scalar, binding = 13) buffer Counts { uint counts[]; };  // visible light samples of a pixel

// Some devices run a loop's body once even if there are zero iterations, and once more than a `for` requires. So loops
// that count are written as do … while, with bodies that are harmless if there is nothing to do.

shared uint histogram[kHistogramWords * kLanes];          // changes of depths, in bytes

// View sample of this lane.
ViewSample at;
vec3 from_center;
float away;                                               // |from_center|
float lift_per_length;                                    // see lift_of
int first_row, last_row;                                  // rows of the band
bool open_pixel;                                          // the host decides all light samples
bool side_in_doubt;                                       // p is within rounding of the plane of some edge's triangle
bool cut_off;                                             // a loop ended early
uint out_of_range;                                        // not 0: some byte of changes overflowed

uint bytes_sum(uint x, uint y) { return ((x & 0x7f7f7f7fu) + (y & 0x7f7f7f7fu)) ^ ((x ^ y) & 0x80808080u); }
// Returns 0x01 in each byte that is 0.
uint zero_bytes(uint x) { return (~(((x & 0x7f7f7f7fu) + 0x7f7f7f7fu) | x) & 0x80808080u) >> 7; }
