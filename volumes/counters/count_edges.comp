// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "engines/device/mask.shared.h"
#include "volumes/edges/device/edge_scatter.glsl"
#include "volumes/counters/depth_complexity.shared.h"

// Second pass of depth complexity (Laine et al. 2005), a workgroup for each view sample: one counter for each light
// sample. D, the number of triangles between p and a light point, is counted triangle by triangle at the corner c0 of
// the light's frame. On the straight segment from c0 to a light sample D changes by k_e(p) at each crossing with a
// projected edge. One lane for each edge while edges are projected, one lane for each light sample while they are
// counted. Light samples within rounding of an edge become questions to the host. docs/depth-complexity.md has the
// proof and derives every bound.

layout(constant_id = 2) const uint kSamples = 256;        // light samples
layout(constant_id = 3) const uint kWords = 8;            // words of a mask
layout(constant_id = 4) const uint kHalves = 0;           // 1: a silhouette counts ±1 and D at c0 is unknown
                                                          // (variant=laine)
layout(constant_id = 5) const uint kKeepsDepths = 0;      // 1: writes the counters, too

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
layout(scalar, binding = 12) readonly buffer Places { vec2 places[]; };   // light samples in the frame, relative to c0:
                                                                          // [0, 2]²
layout(scalar, binding = 13) writeonly buffer Masks { uint masks[]; };    // visible samples: bit j mod 32 of word j /
                                                                          // 32
layout(scalar, binding = 14) writeonly buffer Counts { uint counts[]; };  // visible light samples of a pixel
layout(scalar, binding = 15) buffer Questions {
  QuestionHead asked;
  DepthQuestion questions[];
};
layout(scalar, binding = 16) writeonly buffer Depths { int depths[]; };
// light samples that some triangle touches
layout(scalar, binding = 17) readonly buffer Touched { uint touched_words[]; };

const uint kQueue = 64;
const uint kEach = 8;                                     // light samples that a lane handles at a time

shared int counters[kSamples];
shared uint open_words[kWords], visible_words[kWords];
shared vec4 queue_ends[kQueue];                           // (a, b) relative to c0
shared vec2 queue_more[kQueue];                           // (error, k)

ViewSample at;
vec3 from_center;
float lift_per_length;                                    // see lift_of
bool open_pixel, cut_off;                                 // open_pixel: the host decides everything; cut_off: a loop
                                                          // ended early
bool side_in_doubt, on_triangle;                          // side_in_doubt: p is within rounding of a triangle's plane;
                                                          // on_triangle: p is on an occluding triangle

// Below, a cell has the frame's half-sizes: (X, Y), measured from the light's middle, equals (s, t).

// Projects p + d onto the light: returns its (X, Y), relative to c0, and the height of p + d over p.
precise vec3 project(vec3 d) {
  precise const float w = -dot(axis, d);
  precise const float q = at.height / w;
  precise const vec2 seen = at.foot + q * vec2(dot(across, d), dot(along, d)) - (first_cell - half_cells);
  return vec3(seen, w);
}

// Returns the error of a projected point's coordinates. (bound X)
float error_of(float far, float w, float from_foot, float away) {
  const float q = at.height / w, along_normal = (4.0 + 4.0 * skew) * (far / w + away / at.height);
  return kRound * (8.0 * per_length * far * q + from_foot * (along_normal + 8.0) + per_length * 4.0 * away +
                   16.0 * (half_cells.x + half_cells.y)) +
         (per_length + from_foot / at.height) * push.deviation;
}

// Returns sgn(n · (p − anchor)); sets `open` if the product is within its rounding error.
int side_seen(vec3 n, vec3 anchor, inout bool open) {
  precise const vec3 d = at.p - anchor;
  precise const float f = dot(n, d);
  open = open || (abs(f) <= 8.0 * kRound * dot(abs(n), abs(d)) && n != vec3(0.0));
  return f > 0.0 ? 1 : f < 0.0 ? -1 : 0;
}

// Returns a triangle's contribution to k_e. The carrier's plane contributes nothing, except where silhouettes of closed
// meshes must stay closed (kHalves): there it contributes as seen from slightly above p.
int side_of(vec3 n, vec3 anchor, uint plane, inout bool open) {
  const bool own = plane == at.plane && n != vec3(0.0);
  if (own && kHalves == 0) return 0;
  const float above = dot(n, at.normal);
  const int side = own ? (above > 0.0 ? 1 : above < 0.0 ? -1 : 0) : side_seen(n, anchor, open);
  if (kHalves != 0 && side == 0 && n != vec3(0.0)) open_pixel = true;  // seen edge-on: the silhouette around the
                                                                       // triangle may not be closed
  return side;
}

struct Edge {
  vec2 a, b;                                              // relative to c0
  float error;
  int k;
  bool matters;
};

// Computes this lane's edge. The part outside of a window of twice the light is clipped, so that ends near p's height,
// or behind p, do not affect precision in the window. An unclipped end is computed alike for all edges that meet in it.
Edge see(uint slot, bool used) {
  const int texel = int(slot);
  const uvec4 t0 = texelFetch(record_a, texel), t1 = texelFetch(record_b, texel), t2 = texelFetch(record_n1, texel);
  const uvec4 t3 = texelFetch(record_anchor1, texel), t4 = texelFetch(record_n2, texel), t5 = texelFetch(record_anchor2, texel);
  const vec3 anchor1 = uintBitsToFloat(t3.xyz), anchor2 = uintBitsToFloat(t5.xyz);
  bool open = false;
  const int both = side_of(uintBitsToFloat(t2.xyz), anchor1, t0.w, open) + side_of(uintBitsToFloat(t4.xyz), anchor2, t1.w, open);

  precise const vec3 da = uintBitsToFloat(t0.xyz) - at.p, db = uintBitsToFloat(t1.xyz) - at.p;
  const vec2 window = 4.0 * half_cells;
  const float wa = -dot(axis, da), wb = -dot(axis, db);
  const vec2 xa = vec2(dot(across, da), dot(along, da)) * at.height + (at.foot - first_cell) * wa;
  const vec2 xb = vec2(dot(across, db), dot(along, db)) * at.height + (at.foot - first_cell) * wb;
  const float far_a = length(da), far_b = length(db), far = max(far_a, far_b);
  const vec2 cut_off_by = vec2(cut_far(at.height - wa), cut_far(at.height - wb));
  const float lift = lift_per_length * (far + max(cut_off_by.x, cut_off_by.y));
  const vec2 wide_a = window * (wa + lift), wide_b = window * (wb + lift);
  const vec4 inside_a = vec4(wide_a - xa, wide_a + xa), inside_b = vec4(wide_b - xb, wide_b + xb);
  const vec4 t = inside_a / (inside_a - inside_b);
  float from = 0.0, to = 1.0;
  for (int i = 0; i < 4; ++i) {
    if (inside_a[i] < 0.0) from = max(from, inside_b[i] < 0.0 ? 2.0 : t[i]);
    if (inside_a[i] >= 0.0 && inside_b[i] < 0.0) to = min(to, t[i]);
  }
  const bool cut = from > 0.0 || to < 1.0;
  const vec3 start = from > 0.0 ? mix(da, db, from) : da, end = to < 1.0 ? mix(da, db, to) : db;
  const vec3 seen_a = project(start), seen_b = project(end);

  const float away = length(from_center);
  const vec2 foot = at.foot - (first_cell - half_cells);
  const float foot_a = length(seen_a.xy - foot), foot_b = length(seen_b.xy - foot);
  // If p is within rounding of a triangle's plane, that triangle is a sliver as seen from p. (bound sliver)
  const float sliver = open ? 16.0 * kRound * max(length(anchor1 - at.p), length(anchor2 - at.p)) : 0.0;
  const float far_start = (cut ? far : far_a) + (from > 0.0 ? mix(cut_off_by.x, cut_off_by.y, from) : cut_off_by.x);
  const float far_end = (cut ? far : far_b) + (to < 1.0 ? mix(cut_off_by.x, cut_off_by.y, to) : cut_off_by.y);
  const float error_a = error_of(far_start, seen_a.z, foot_a, away) + (at.height * per_length + foot_a) / seen_a.z * sliver;
  const float error_b = error_of(far_end, seen_b.z, foot_b, away) + (at.height * per_length + foot_b) / seen_b.z * sliver;

  const bool seen = used && (both != 0 || open) && from <= to;
  const float least = 64.0 * kRound;
  const bool through_p = seen && (seen_a.z < least * max(far, far_start) || seen_b.z < least * max(far, far_end));
  open_pixel = open_pixel || through_p;                   // the edge passes through p within rounding
  side_in_doubt = side_in_doubt || (seen && open);
  Edge edge;
  edge.a = seen_a.xy;
  edge.b = seen_b.xy;
  edge.error = 1.5 * max(error_a, error_b) + 128.0 * kRound * skew;  // (bound near)
  const int k = push.side < 0.0 ? -both : both;           // seen from behind, counter-clockwise is clockwise in (X, Y)
  edge.k = kHalves == 0 ? k : clamp(k, -1, 1);
  const vec2 low = min(edge.a, edge.b) - edge.error, high = max(edge.a, edge.b) + edge.error, size = 2.0 * half_cells;
  const bool beside = any(greaterThan(low, size)) || any(lessThan(high, vec2(0.0)));
  edge.matters = seen && !through_p && !beside;
  return edge;
}

// Returns the unit direction of an edge, given the difference d of its ends and its length. If the ends are so close
// that the edge is a point relative to its error (2⁻¹⁷ of a cell or more, bound near), returns any unit vector.
// (1e-12)² is a normal float, so longer lengths are computed correctly.
vec2 direction_of(vec2 d, float size) { return size > 1e-12 ? d / size : vec2(1.0, 0.0); }

// Returns whether x is within `error` of the edge from a to b. `direction` has unit length.
bool is_near(vec2 x, vec2 a, vec2 direction, float size, float error) {
  const vec2 d = x - a;
  const float forward = dot(d, direction), aside = direction.x * d.y - direction.y * d.x;
  return abs(aside) < error && forward > -error && forward < size + error;
}

// Returns the side of the segment from c0 to x on which a point lies: one decision for all edges that meet in the
// point.
precise float beside_direction(vec2 x, vec2 point) {
  precise const float left = x.x * point.y;
  precise const float right = x.y * point.x;
  precise const float difference = left - right;
  return difference;
}

// Adds the queued edges to all counters.
void drain(uint queued) {
  subgroupMemoryBarrierShared();
  subgroupBarrier();
  uint first = gl_SubgroupInvocationID;
  for (; first < kSamples; first += kEach * kLanes) {
    vec2 x[kEach];
    int change[kEach];
    bool open[kEach];
    for (uint i = 0; i < kEach; ++i) {
      x[i] = places[min(first + i * kLanes, kSamples - 1)];
      change[i] = 0;
      open[i] = false;
    }
    uint e = 0;
    for (; e < queued; ++e) {
      const vec4 ends = queue_ends[e];
      const vec2 more = queue_more[e], a = ends.xy, b = ends.zw, d = b - a;
      const float size = sqrt(dot(d, d));
      const vec2 direction = direction_of(d, size);
      const int k = int(more.y);
      for (uint i = 0; i < kEach; ++i) {
        const float side_a = beside_direction(x[i], a), side_b = beside_direction(x[i], b);
        const float along_a = dot(x[i], a), along_b = dot(x[i], b);
        const float crossing = clamp((along_a * side_b - along_b * side_a) / (side_b - side_a), min(along_a, along_b), max(along_a, along_b));
        const bool crosses = (side_a > 0.0) != (side_b > 0.0) && crossing > 0.0 && crossing < dot(x[i], x[i]);
        change[i] += crosses ? (side_a > 0.0 ? k : -k) : 0;
        open[i] = open[i] || is_near(x[i], a, direction, size, more.x);
      }
    }
    for (uint i = 0; i < kEach; ++i) {
      const uint j = first + i * kLanes;
      if (j < kSamples) {
        counters[j] += change[i];
        if (open[i]) atomicOr(open_words[j / 32], 1u << (j % 32));
      }
    }
    cut_off = cut_off || e < queued;
  }
  cut_off = cut_off || first < kSamples;
  subgroupMemoryBarrierShared();
  subgroupBarrier();
}

// Some devices execute code that a branch skips: `drain` is called once for many edges, not in the loop that collects
// them.
void count_list(uint head) {
  uint queued = 0, piece = head, i = 0;
  uint count = piece == kNone ? 0 : lists[piece + 1];
  while (piece != kNone) {
    for (; i < count && queued + kLanes <= kQueue; i += kLanes) {
      const bool used = i + gl_SubgroupInvocationID < count;
      const Edge edge = see(lists[piece + 2 + (used ? i + gl_SubgroupInvocationID : 0)], used);
      // If c0 is within an edge's error of it, D at c0 may not agree with the edges as projected.
      const vec2 d = edge.b - edge.a;
      const float size = sqrt(dot(d, d));
      open_pixel = open_pixel || (edge.matters && is_near(vec2(0.0), edge.a, direction_of(d, size), size, edge.error));
      const uvec4 all = subgroupBallot(edge.matters);
      const uint place = queued + subgroupBallotExclusiveBitCount(all);
      if (edge.matters) {
        queue_ends[place] = vec4(edge.a, edge.b);
        queue_more[place] = vec2(edge.error, float(edge.k));
      }
      queued += subgroupBallotBitCount(all);
    }
    const bool room = queued + kLanes <= kQueue;
    if (i >= count) {
      piece = lists[piece];
      i = 0;
      count = piece == kNone ? 0 : lists[piece + 1];
    } else if (room) {
      cut_off = true;                                     // the loop above was cut off
      break;
    }
    if (!room || piece == kNone) {
      drain(queued);
      queued = 0;
    }
  }
  cut_off = cut_off || piece != kNone;
}

#include "volumes/counters/count_to_corner.glsl"

void ask(uint pixel, uint word, uint bits) {
  const uint question = atomicAdd(asked.count, 1);
  if (question < push.question_capacity) questions[question] = DepthQuestion(pixel, word, bits);
}

// Writes one result for the whole mask: all visible, none visible (the mask is then not read), or all open. Has no
// loop: a driver that ended a loop may have no iterations left.
void settle_whole(uint pixel, bool visible, bool open) {
  if (gl_SubgroupInvocationID != 0) return;
  counts[pixel] = visible ? kSamples : 0;
  if (open) ask(pixel, kAllWords, 0);
}

// Sets counters of light samples not strictly above the carrier's plane to `kDark`. (bound horizon)
const int kDark = 0x40000000;
void cut_at_horizon(vec3 above, float error) {
  uint j = gl_SubgroupInvocationID;
  for (; j < kSamples; j += kLanes) {
    const vec2 light_point = places[j] - half_cells;
    const float value = above.x * light_point.x + above.y * light_point.y + above.z;
    if (value <= error) counters[j] = kDark;
    if (abs(value) <= error) atomicOr(open_words[j / 32], 1u << (j % 32));
  }
  cut_off = cut_off || j < kSamples;
}

bool is_open(uint j) { return (open_words[j / 32] >> (j % 32) & 1) != 0; }

// Returns (counter, light sample) of the light sample with the smallest counter among those that are not open; kNone if
// there is none.
uvec2 least() {
  int low = kDark;
  uint j = gl_SubgroupInvocationID;
  for (; j < kSamples; j += kLanes) {
    if (!is_open(j)) low = min(low, counters[j]);
  }
  cut_off = cut_off || j < kSamples;
  low = subgroupMin(low);
  uint who = kNone;
  for (j = gl_SubgroupInvocationID; j < kSamples; j += kLanes) {
    if (!is_open(j) && counters[j] == low && low != kDark) who = min(who, j);
  }
  cut_off = cut_off || j < kSamples;
  return uvec2(uint(low), subgroupMin(who));
}

void main() {
  make_frame();
  const uint in_band = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x, pixel = push.first_pixel + in_band;
  if (in_band >= push.width * push.row_count) return;
  const uint block = in_band / push.width / kBlock * ((push.width + kBlock - 1) / kBlock) + in_band % push.width / kBlock;
  at = fetch_view_sample(in_band);
  from_center = at.p - push.center;
  lift_per_length = lift_of(at, 4.0 * half_cells);
  open_pixel = false;
  cut_off = false;
  side_in_doubt = false;
  on_triangle = false;

  const bool receives = at.carrier != kNone;
  // Condition (2) of docs/definitions.md: p is strictly on an emitting side of the light's plane. (bound level)
  const float error_level = level_error(at.p);
  const bool this_side = receives && at.height > error_level, other_side = receives && at.height < -error_level;
  if (!this_side) {
    if (push.side > 0.0 && !(other_side && push.keeps_rest != 0)) settle_whole(pixel, !receives, receives && !other_side);
    return;
  }
  // Condition (1) of docs/definitions.md: the light sample is strictly above the carrier's plane. The part of the light
  // above that plane is bounded by one line. (bound horizon)
  const vec3 towards = -from_center;
  const vec3 above = vec3(dot(at.normal, push.u), dot(at.normal, push.v), dot(at.normal, towards));
  const float error_above = 16.0 * kRound * (size1(towards) + size1(push.u) + size1(push.v) + size1(at.p)) + push.deviation;
  const float span = abs(above.x) + abs(above.y);
  const bool below = above.z + span < -error_above, straddles = above.z - span <= error_above;

  const uint list = 2 * (block * kClusters + (below ? 0 : heads[2 * kClusters * block_count() + in_band]));
  const uint edges = below ? kNone : heads[list], triangles = below || kHalves != 0 ? kNone : heads[list + 1];
  const int depth = triangles != kNone ? int(count_to_corner(triangles)) : 0;
  uint j = gl_SubgroupInvocationID, word = j;
  for (; j < kSamples; j += kLanes) counters[j] = depth;
  for (; word < kWords; word += kLanes) {
    open_words[word] = touched_words[word];
    visible_words[word] = 0;
  }
  cut_off = cut_off || j < kSamples || word < kWords;
  subgroupMemoryBarrierShared();
  subgroupBarrier();
  if (edges != kNone) count_list(edges);
  if (kKeepsDepths != 0 && !below) {
    for (j = gl_SubgroupInvocationID; j < kSamples; j += kLanes) depths[pixel * kSamples + j] = counters[j];
    cut_off = cut_off || j < kSamples;
  }
  const bool flat_direction = sees_flat(length(from_center), at.height);
  // p is on a triangle within rounding: half of all directions from p depend on the side that p is on. (bound on)
  const bool on_some = subgroupAny(side_in_doubt) && subgroupAny(on_triangle);
  if (subgroupAny(open_pixel || cut_off) || on_some || flat_direction || below) {
    settle_whole(pixel, false, !below);
    return;
  }
  if (straddles) cut_at_horizon(above, error_above);
  subgroupMemoryBarrierShared();
  subgroupBarrier();
  const uvec2 reference = kHalves != 0 ? least() : uvec2(0);
  for (j = gl_SubgroupInvocationID; j < kSamples; j += kLanes) {
    if (counters[j] == int(reference.x) && reference.y != kNone && !is_open(j)) atomicOr(visible_words[j / 32], 1u << (j % 32));
  }
  cut_off = cut_off || j < kSamples;
  subgroupMemoryBarrierShared();
  subgroupBarrier();
  uint visible = 0;
  for (word = gl_SubgroupInvocationID; word < kWords; word += kLanes) {
    masks[pixel * kWords + word] = visible_words[word];
    visible += bitCount(visible_words[word]);
    if (open_words[word] != 0) ask(pixel, word, open_words[word]);
  }
  if (subgroupAny(cut_off || word < kWords)) {
    settle_whole(pixel, false, true);
    return;
  }
  visible = subgroupAdd(visible);
  if (gl_SubgroupInvocationID == 0) {
    counts[pixel] = visible;
    if (kHalves != 0 && reference.y != kNone) ask(pixel, kReference | reference.y, 0);
  }
}
