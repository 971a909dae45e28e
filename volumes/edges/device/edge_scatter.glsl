// SPDX-License-Identifier: Apache-2.0
// Shared by the passes of edge scatter: a workgroup is one subgroup. docs/edge-scatter.md derives every bound.
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_vote : require
#include "volumes/edges/device/edge_scatter.shared.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kLanes = 8;            // the workgroup's size, one subgroup

layout(binding = 0) uniform usamplerBuffer view;          // 2 texels for each pixel: (p, carrying triangle), (normal,
                                                          // plane)
// 2 words for each cluster, kClusters clusters for each block: its lists of edges and of triangles; then 1 word for
// each pixel: its cluster.
layout(scalar, binding = 1) buffer Heads { uint heads[]; };
// A list is a chain of pieces: the index of the next piece, the number of items, the items (slots of the hierarchy's
// leaves).
layout(scalar, binding = 2) buffer Lists {
  uint list_words, unfinished;
  uint lists[];
};
layout(scalar, push_constant) uniform Push { ScatterPush push; };

const uint kTeam = 8;                                     // children of a node, records of a leaf
// A team of lanes handles a node's children. A subgroup has several teams, or one that takes several rounds (turns).
const uint kTeams = kLanes < kTeam ? 1 : kLanes / kTeam, kTurns = kLanes < kTeam ? kTeam / kLanes : 1;
const uint kBlock = 8;                                    // a block is kBlock × kBlock pixels
const uint kClusters = 4;                                 // most clusters of view samples in a block
const uint kNone = 0xffffffffu, kLeafBit = 0x80000000u;
const float kRound = 1.0 / 16777216.0;                    // 2⁻²⁴: half a unit in the last place of 1

// Returns the number of blocks in the band.
uint block_count() { return (push.width + kBlock - 1) / kBlock * ((push.row_count + kBlock - 1) / kBlock); }

float size1(vec3 x) { return abs(x.x) + abs(x.y) + abs(x.z); }

// The light as a frame for (X, Y), in cells: X = 0 is the middle of the first column, Y = 0 the first row. A point x is
// at height axis · (x − center) over the light's plane, and above (across · (x − center), along · (x − center)) of it.
vec3 axis, across, along;
vec2 half_cells;                                          // from the light's middle to its sides
vec2 first_cell;                                          // (X, Y) of the light's middle
float per_length;                                         // bounds |across|, |along|
float skew;                                               // at least 1: 1 / sine of the angle of u and v

void make_frame() {
  const vec3 n = cross(push.u, push.v);
  const float squared = dot(n, n);
  half_cells = 0.5 * vec2(float(push.columns), float(push.rows));
  axis = push.side * normalize(n);
  across = cross(push.v, n) / squared * half_cells.x;
  along = cross(n, push.u) / squared * half_cells.y;
  first_cell = half_cells - 0.5;
  per_length = max(length(across), length(along));
  skew = size1(push.u) * size1(push.v) / sqrt(squared);
}

// A view sample: p and the values that depend on it alone.
struct ViewSample {
  vec3 p;
  uint carrier, plane;
  vec3 normal;
  float height;                                           // over the light's plane (bound level)
  vec2 foot;                                              // (X, Y) of the orthogonal projection of p onto the light's
                                                          // plane
};

ViewSample view_sample_at(vec3 p) {
  const vec3 from = p - push.center;
  return ViewSample(p, kNone, kNone, vec3(0.0), dot(axis, from), vec2(dot(across, from), dot(along, from)) + first_cell);
}

ViewSample fetch_view_sample(uint pixel) {
  const int texel = int(2 * (push.first_row * push.width + pixel));
  const uvec4 first = texelFetch(view, texel), second = texelFetch(view, texel + 1);
  ViewSample at = view_sample_at(uintBitsToFloat(first.xyz));
  at.carrier = first.w;
  at.normal = uintBitsToFloat(second.xyz);
  at.plane = second.w;
  return at;
}

float level_error(vec3 p) { return 16.0 * kRound * skew * (size1(push.center - p) + size1(p)) + push.deviation; }

// Returns whether something is close to the light's plane and, at the same time, a segment from p to a light sample may
// rise by less than 1 / 256 of its length. `away`: |p − center|. (visibility/lights/light_touch)
bool sees_flat(float away, float height) {
  const float farthest = away + 1.0001 * (length(push.u) + length(push.v)) + push.deviation;
  return push.near_plane != 0 && height < farthest / 256.0;
}

// Returns the distance below p's height within which an edge may still pass through p within rounding, in lengths of
// the edge's farther end. (bound window)
float lift_of(ViewSample at, vec2 window) {
  const vec2 off = abs(at.foot - first_cell);
  return 64.0 * kRound * (1.0 + 0.125 * (max(off.x, off.y) + per_length * at.height) / min(window.x, window.y));
}

// Returns the rounding error of an end that may have been cut at the light's plane, given its height over that plane.
// The error is a length that is added to the length of the end's vector. (bound cut)
float cut_far(float over_light) { return over_light < 512.0 * kRound * push.reach ? push.cut_reach / 4.0 : 0.0; }

// Returns whether p is within rounding of the triangle with corners p + da, p + db, p + dc. (bound on)
bool is_on_triangle(vec3 da, vec3 db, vec3 dc) {
  const vec3 n = cross(db - da, dc - da);
  const float size = length(n), far = max(length(da), max(length(db), length(dc))), unit = kRound * far;
  const float least = min(dot(n, cross(da, db)), min(dot(n, cross(db, dc)), dot(n, cross(dc, da))));
  return abs(dot(n, da)) <= 128.0 * kRound * push.reach * size + 64.0 * unit * far * far &&
         least >= -(256.0 * unit * push.reach * size + 64.0 * unit * far * far * far);
}

// The hull of view samples and a rectangle of the light's plane, `low` to `high` in cells from the light's middle. It
// is bounded by two parallel planes, and by n·x ≤ beyond for four planes, one in each component of nx, ny, nz. (bound
// shaft)
struct Shaft {
  float lowest, highest;                                  // along the axis
  vec4 nx, ny, nz, beyond;
};

// `slopes`: the largest (foot − high) / height, and the largest (low − foot) / height; feet in cells from the light's
// middle.
Shaft make_shaft(vec2 low, vec2 high, vec4 slopes, float height) {
  Shaft shaft;
  const vec4 signs = vec4(1.0, -1.0, 1.0, -1.0);
  shaft.nx = vec4(across.xx, along.xx) * signs - slopes * axis.x;
  shaft.ny = vec4(across.yy, along.yy) * signs - slopes * axis.y;
  shaft.nz = vec4(across.zz, along.zz) * signs - slopes * axis.z;
  const vec4 sizes = abs(shaft.nx) + abs(shaft.ny) + abs(shaft.nz) + vec4(vec2(size1(across)), vec2(size1(along)));
  const float widest = max(half_cells.x, half_cells.y);
  shaft.beyond = shaft.nx * push.center.x + shaft.ny * push.center.y + shaft.nz * push.center.z +
                 vec4(high.x, -low.x, high.y, -low.y) + 64.0 * kRound * (2.0 * push.reach * sizes + skew * widest) +
                 sizes * push.deviation;
  const float slack = 128.0 * kRound * push.reach + push.deviation, light_level = dot(axis, push.center);
  shaft.highest = light_level + height + slack;
  shaft.lowest = light_level - slack;
  return shaft;
}

vec4 slopes_of(vec2 low, vec2 high, vec2 foot, float height) {
  const vec2 from_middle = foot - first_cell;
  const vec4 over = vec4(from_middle.x - high.x, low.x - from_middle.x, from_middle.y - high.y, low.y - from_middle.y);
  return over / height;
}

// Returns a triangle's contribution to k_e for all view samples in the box middle ± half_size: −1, 0 or 1; or 2 if the
// contribution is not the same for all, is not certain, or one of them may lie on the triangle, since p deviates from
// its carrier's plane by its rounding. (bound side)
int side_for_all(vec3 n, vec3 anchor, vec3 middle, vec3 half_size) {
  const vec3 d = middle - anchor;
  const float f = dot(n, d);
  const float spread = dot(abs(n), half_size) * 1.001 + kRound * (32.0 * dot(abs(n), abs(d) + half_size) + 4.0 * size1(n) * push.reach);
  return n == vec3(0.0) ? 0 : f > spread ? 1 : f < -spread ? -1 : 2;
}
