// What scatter_edges.comp and scatter_points.comp share: what they are given, and what a lane knows of its view sample.

layout(constant_id = 2) const uint kGroupWidth = 4;       // pixels; its height is lanes / width
// 3 and 4 are in scatter_rows.glsl and scatter_points.glsl.
layout(constant_id = 5) const uint kHistogramWords = 64;  // a lane

// An edge record (EdgeTexels), a texel buffer each: (a, plane 1), (b, plane 2), (n 1), (anchor 1), (n 2), (anchor 2).
layout(binding = 3) uniform usamplerBuffer record_a;
layout(binding = 4) uniform usamplerBuffer record_b;
layout(binding = 5) uniform usamplerBuffer record_n1;
layout(binding = 6) uniform usamplerBuffer record_anchor1;
layout(binding = 7) uniform usamplerBuffer record_n2;
layout(binding = 8) uniform usamplerBuffer record_anchor2;
// A triangle: (a, triangle), (b, plane), (c, light that it is the body of).
layout(binding = 9) uniform usamplerBuffer corner_a;
layout(binding = 10) uniform usamplerBuffer corner_b;
layout(binding = 11) uniform usamplerBuffer corner_c;
layout(scalar, binding = 12) buffer Masks { uint masks[]; };    // visible light samples
layout(scalar, binding = 13) buffer Counts { uint counts[]; };  // visible light samples of a pixel

// Some devices run a loop's body once even for no turn at all, and once more than a `for` asks: loops that count are
// written do … while, their bodies harmless where there is nothing to do.

shared uint histogram[kHistogramWords * kLanes];          // changes of depths, in bytes

// This lane's view sample.
ViewSample at;
vec3 from_center;
float away;                                               // |from_center|
float lift_per_length;                                    // lift_of
int first_row, last_row;                                  // of the band
bool open_pixel;                                          // all light samples are for the host
bool side_in_doubt;                                       // of some edge's triangle: within rounding of p
bool cut_off;                                             // a loop did not run to its end
uint out_of_range;                                        // not 0: some byte of changes had no room

uint bytes_sum(uint x, uint y) { return ((x & 0x7f7f7f7fu) + (y & 0x7f7f7f7fu)) ^ ((x ^ y) & 0x80808080u); }
// 0x01 in each byte that is 0.
uint zero_bytes(uint x) { return (~(((x & 0x7f7f7f7fu) + 0x7f7f7f7fu) | x) & 0x80808080u) >> 7; }
