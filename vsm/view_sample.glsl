// SPDX-License-Identifier: Apache-2.0
// Shared by the two passes of view-sample mapping. One workgroup is one subgroup and handles one block of neighbouring
// pixels; a lane handles first a child's box, then a triangle, then a view sample. docs/view-sample.md derives every
// bound, under the names used here.
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_vote : require
#include "engines/device/mask.shared.h"
#include "vsm/view_sample.shared.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kLanes = 8;            // the workgroup's size, one subgroup
layout(constant_id = 2) const uint kScatteredPoints = 0;  // 0: rows of equidistant samples; 1: any points, sorted by t
layout(constant_id = 3) const uint kWordsPerRow = 1;      // rows: words of one row's bits in shared memory
layout(constant_id = 4) const uint kSharedWords = 16;     // words for each lane
layout(constant_id = 5) const uint kBlockWidth = 4;       // pixels of a block in x; its height is lanes / width
layout(constant_id = 6) const uint kChunk = 32;           // leaves of a chunk
layout(constant_id = 7) const uint kStackSize = 64;

layout(binding = 0) uniform usamplerBuffer view;          // 2 texels for each pixel: (p, carrying triangle), (normal,
                                                          // plane and part)
layout(scalar, binding = 1) readonly buffer Samples {
  uint first_point[257];                                  // scattered: first point with t ≥ −1 + i / 128
  vec2 samples[];                                         // scattered: (s, t)
};
layout(scalar, binding = 2) buffer Masks { uint masks[]; };  // visible light samples, words of each pixel
layout(scalar, binding = 3) buffer Questions {
  QuestionHead asked;
  OpenQuestion questions[];
};
// A chunk is 2 + kChunk words: the block (top bit: on the light's back side), a bit for each closed part that all its
// view samples are outside of, and leaves of the tree that its shaft meets.
layout(scalar, binding = 4) buffer Chunks {
  uint chunk_count, unfinished;
  uint chunks[];
};
layout(scalar, push_constant) uniform Push { ViewSamplePush push; };

const uint kTeam = 8;                                     // children of a node, triangles of a leaf
// A team of lanes handles a node's children. A subgroup has several teams, or one that takes several rounds (turns).
const uint kTeams = kLanes < kTeam ? 1 : kLanes / kTeam, kTurns = kLanes < kTeam ? kTeam / kLanes : 1;
const uint kNone = 0xffffffffu, kLeafBit = 0x80000000u, kBackBit = 0x80000000u;
const uint kPartShift = 27, kPlaneMask = (1u << kPartShift) - 1;  // a word holds a plane's index and, above it, a
                                                                  // closed part's
const uint kChunkHead = 2;                                // words before the leaves
const float kRound = 1.0 / 16777216.0;                    // 2⁻²⁴: half a unit in the last place of 1

shared uint blocked[kSharedWords * kLanes];

// View sample of this lane.
uint pixel;                                               // index in the tile
bool inside;                                              // whether the pixel is in the picture
uint carrier, carrier_plane, carrier_part;
vec3 p, normal;
vec3 towards;                                             // the light's centre − p
float level, level_error;                                 // > 0: p lies on the side that u × v points to (bound level)

uint slot_of(uint word) { return word * kLanes + gl_SubgroupInvocationID; }
float size1(vec3 x) { return abs(x.x) + abs(x.y) + abs(x.z); }
// Returns bits first … last (in 0 … 31, first ≤ last) of a word.
uint bits(int first, int last) { return (0xffffffffu << first) & (0xffffffffu >> (31 - last)); }

void load_view_sample(uint block) {
  const uint block_height = kLanes / kBlockWidth, blocks_across = (push.width + kBlockWidth - 1) / kBlockWidth;
  const uint x = block % blocks_across * kBlockWidth + gl_SubgroupInvocationID % kBlockWidth;
  const uint y = block / blocks_across * block_height + gl_SubgroupInvocationID / kBlockWidth;
  inside = x < push.width && y < push.band_rows;
  pixel = inside ? (push.band_first + y) * push.width + x : 0;
  const int texel = int(2 * (push.first_row * push.width + pixel));
  const uvec4 first = texelFetch(view, texel), second = texelFetch(view, texel + 1);
  p = uintBitsToFloat(first.xyz);
  normal = uintBitsToFloat(second.xyz);
  carrier = first.w;
  carrier_plane = second.w & kPlaneMask;
  carrier_part = second.w >> kPartShift;
  towards = push.center - p;
  level = -dot(cross(push.u, push.v), towards);
  level_error = size1(push.u) * size1(push.v) * (16.0 * kRound * (size1(towards) + size1(p)) + push.deviation);
}

void ask(uint hider, uint light_sample) {
  const uint at = atomicAdd(asked.count, 1);
  if (at < push.question_capacity) questions[at] = OpenQuestion(pixel, hider, light_sample);
}

bool is_blocked(uint light_sample) {
  if (kScatteredPoints != 0) return (blocked[slot_of(light_sample >> 5)] >> (light_sample & 31) & 1) != 0;
  const uint row = light_sample / push.columns, column = light_sample % push.columns;
  return (blocked[slot_of(row * kWordsPerRow + (column >> 5))] >> (column & 31) & 1) != 0;
}

// Four half-planes of the light, one in each component: F(s, t) = x s + y t + z, each known up to ±error.
struct HalfPlanes {
  vec4 x, y, z, error;
};

// Marks samples by the half-planes: where all are certainly positive the sample is blocked; where none is certainly
// negative, but some are uncertain, the sample becomes a question. Only samples with (s, t) in `box` (lower, upper) are
// tested.
void mark_points(HalfPlanes f, vec4 box, uint triangle) {
  const uint begin = first_point[clamp(int(floor((box.y + 1.0) * 128.0)) - 1, 0, 256)];
  const uint end = first_point[clamp(int(ceil((box.w + 1.0) * 128.0)) + 1, 0, 256)];
  for (uint j = begin; j < end; ++j) {
    const vec2 at = samples[j];
    const vec4 value = f.x * at.x + f.y * at.y + f.z;
    if (all(greaterThan(value, f.error))) {
      blocked[slot_of(j >> 5)] |= 1u << (j & 31);
    } else if (all(greaterThanEqual(value, -f.error)) && !is_blocked(j)) {
      ask(triangle, j);
    }
  }
}

// Returns (s of column 0, t) of a row; twin of visibility::row_shift_of.
vec2 row_start(int row) {
  const int shift = int((uint(row) * push.shift_step + 32768u) & 0xffffu) - 32768;
  return vec2((1.0 + float(shift) / 32768.0) / float(push.columns) - 1.0, float(2 * row + 1) / float(push.rows) - 1.0);
}

// Marks, in each row, the columns inside all half-planes. Each half-plane is a range of columns: certainly inside
// beyond x + slack, certainly outside below x − slack (rising), or the reverse (falling). (bound row)
void mark_rows(HalfPlanes f, vec4 box, uint triangle) {
  const float last_column = float(push.columns) - 1.0, spacing = 2.0 / float(push.columns);
  const vec4 slope = f.x * spacing;
  const bvec4 rising = greaterThanEqual(slope, vec4(0.0));
  // A slope so small that the value hardly changes along the row may be replaced by a larger one: the change stays
  // within slack.
  const vec4 least = f.error / (16.0 * float(push.columns));
  const vec4 inverse = 1.0 / mix(min(slope, -least), max(slope, least), rising);
  const vec4 at_0 = -f.z * inverse, per_t = -f.y * inverse, per_s = -f.x * inverse;
  const vec4 slack = 1.25 * f.error * abs(inverse) + float(push.columns) * (8.0 * kRound);
  const float half_rows = 0.5 * float(push.rows);
  const int first_row = max(int(ceil((max(box.y, -1.0) + 1.0) * half_rows - 0.51)), 0);
  const int last_row = min(int(floor((min(box.w, 1.0) + 1.0) * half_rows - 0.49)), int(push.rows) - 1);
  for (int row = first_row; row <= last_row; ++row) {
    const vec2 at = row_start(row);                       // column k is at s = at.x + spacing · k
    const vec4 x = at_0 + per_t * at.y + per_s * at.x;
    const vec4 far = vec4(1e9);
    const vec4 certain_froms = mix(-far, x + slack, rising), possible_froms = mix(-far, x - slack, rising);
    const vec4 certain_tos = mix(x - slack, far, rising), possible_tos = mix(x + slack, far, rising);
    const float possible_from = max(max(max(possible_froms.x, possible_froms.y), max(possible_froms.z, possible_froms.w)),
                                    max((box.x - at.x) / spacing - 0.01, 0.0));
    const float possible_to = min(min(min(possible_tos.x, possible_tos.y), min(possible_tos.z, possible_tos.w)),
                                  min((box.z - at.x) / spacing + 0.01, last_column));
    const float certain_from = max(max(max(certain_froms.x, certain_froms.y), max(certain_froms.z, certain_froms.w)), 0.0);
    const float certain_to = min(min(min(certain_tos.x, certain_tos.y), min(certain_tos.z, certain_tos.w)), last_column);
    const int from = int(ceil(min(possible_from, far.x))), to = int(floor(max(possible_to, -1.0)));
    const int sure_from = int(ceil(min(certain_from, far.x))), sure_to = int(floor(max(certain_to, -1.0)));
    if (sure_from <= sure_to) {
      for (int word = sure_from >> 5; word <= sure_to >> 5; ++word) {
        blocked[slot_of(uint(row) * kWordsPerRow + uint(word))] |= bits(max(sure_from - 32 * word, 0), min(sure_to - 32 * word, 31));
      }
    }
    for (int k = from; k <= to; ++k) {
      if (k == sure_from && sure_from <= sure_to) k = sure_to + 1;
      const uint light_sample = uint(row) * push.columns + uint(k);
      if (k <= to && !is_blocked(light_sample)) ask(triangle, light_sample);
    }
  }
}

void mark(HalfPlanes f, vec4 box, uint triangle) {
  if (kScatteredPoints != 0) {
    mark_points(f, box, triangle);
  } else {
    mark_rows(f, box, triangle);
  }
}

const vec4 kWholeLight = vec4(-1.0, -1.0, 1.0, 1.0);
const vec3 kAlways = vec3(0.0, 0.0, 1.0);                 // a half-plane that contains the whole light,
const float kAlwaysError = 0.5;                           // and an error with which this is certain

// Clears this lane's blocked samples in its mask in memory. Rows may end within a word. Returns false if the driver
// ended the loop early.
bool take_from_mask() {
  const uint words = (push.sample_count + 31) / 32;
  uint i = 0;
  for (; i < kSharedWords; ++i) {
    const uint value = blocked[slot_of(i)];
    if (value == 0) continue;
    if (kScatteredPoints != 0) {
      atomicAnd(masks[pixel * words + i], ~value);
      continue;
    }
    const uint bit = i / kWordsPerRow * push.columns + i % kWordsPerRow * 32, shift = bit & 31;
    atomicAnd(masks[pixel * words + (bit >> 5)], ~(value << shift));
    if (shift != 0 && value >> (32 - shift) != 0) atomicAnd(masks[pixel * words + (bit >> 5) + 1], ~(value >> (32 - shift)));
  }
  return i >= kSharedWords;
}

// The shaft from this block's view samples (those `on`) to the light: the hull of both lies between two parallel planes
// and in n·x ≤ beyond for four planes through the light's edges, one in each component of nx, ny, nz. (bound shaft)
struct Shaft {
  vec3 axis;                                              // away from the light
  float lowest, highest;                                  // along the axis
  vec4 nx, ny, nz, beyond;
  float front;                                            // positions beyond this along the axis are certainly off the
                                                          // light's plane
};

Shaft make_shaft(bool on, float side) {
  Shaft shaft;
  shaft.axis = side * normalize(cross(push.u, push.v));
  // Coordinates along u and v, which need not be orthogonal: uses the dual basis.
  const vec3 n = cross(push.u, push.v);
  const vec3 u_dual = cross(push.v, n) / dot(n, n), v_dual = cross(n, push.u) / dot(n, n);
  const float skew = size1(push.u) * size1(push.v) / length(n);  // at least 1: 1 / sine of their angle
  const float height = on ? -dot(shaft.axis, towards) : 0.0;
  const float along_u = -dot(u_dual, towards), along_v = -dot(v_dual, towards);
  const float inverse = on ? 1.0 / height : 0.0, none = -1e18;
  // Each plane has the largest slope at which a view sample sees past its edge of the light.
  const vec4 slope = vec4(subgroupMax(on ? (along_u - 1.0) * inverse : none), subgroupMax(on ? (-along_u - 1.0) * inverse : none),
                          subgroupMax(on ? (along_v - 1.0) * inverse : none), subgroupMax(on ? (-along_v - 1.0) * inverse : none));
  shaft.nx = vec4(u_dual.x, -u_dual.x, v_dual.x, -v_dual.x) - slope * shaft.axis.x;
  shaft.ny = vec4(u_dual.y, -u_dual.y, v_dual.y, -v_dual.y) - slope * shaft.axis.y;
  shaft.nz = vec4(u_dual.z, -u_dual.z, v_dual.z, -v_dual.z) - slope * shaft.axis.z;
  const vec4 sizes = abs(shaft.nx) + abs(shaft.ny) + abs(shaft.nz) + vec4(vec2(size1(u_dual)), vec2(size1(v_dual)));
  shaft.beyond = shaft.nx * push.center.x + shaft.ny * push.center.y + shaft.nz * push.center.z + 1.0 +
                 64.0 * kRound * (2.0 * push.reach * sizes + skew) + sizes * push.deviation;
  const float slack = 128.0 * kRound * push.reach + push.deviation, light_level = dot(shaft.axis, push.center);
  shaft.highest = light_level + subgroupMax(height) + slack;
  shaft.lowest = light_level - slack;
  shaft.front = light_level + slack;
  return shaft;
}
