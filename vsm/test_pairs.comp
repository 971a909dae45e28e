// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "vsm/view_sample.glsl"

// Second pass of view-sample mapping: finds, for every pair of a view sample and a triangle, the set of light samples
// that the triangle hides, and ORs these sets (Eisemann-Décoret 2007; Sintorn et al. 2008). Departing from the papers,
// nothing is decided by rounding: the plane of each edge has an error bound, light samples within it are recorded as
// open questions, and the host answers these with exact predicates. Bounds: docs/view-sample.md.

layout(binding = 5) uniform usamplerBuffer corner_a;      // for each leaf slot: (a, triangle)
layout(binding = 6) uniform usamplerBuffer corner_b;      // for each leaf slot: (b, plane and closed part)
layout(binding = 7) uniform usamplerBuffer corner_c;      // for each leaf slot: (c, light whose body it belongs to)

shared uint again[kChunk * kTeam + 1];

struct Corners {
  vec3 a, b, c;
  uint triangle, plane, part;
  int light;
};

Corners fetch(uint slot) {
  const uvec4 a = texelFetch(corner_a, int(slot)), b = texelFetch(corner_b, int(slot)), c = texelFetch(corner_c, int(slot));
  return Corners(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz), a.w, b.w & kPlaneMask,
                 b.w >> kPartShift, int(c.w));
}

float orientation;                                        // ±1: makes W positive toward the light
vec3 row_s, row_t, row_w;                                 // d ↦ (S, T, W): the light point (S/W, T/W) lies behind d
float r;                                                  // R = max(|u|, |v|) · max(|c − p|, |u|, |v|)
float light_pad;                                          // enlargement of a box by the deviation of the light samples
float edge_error, det_error;                              // errors of edges and of det, to be multiplied by lengths
const float kLeastError = 1e-33;                          // above the effect of underflow on an edge's values, and
                                                          // large enough for a finite reciprocal
const float kUnderflow = 1e-36;                           // above the effect of underflow on a sum of products

vec3 to_light(vec3 d) { return vec3(dot(row_s, d), dot(row_t, d), dot(row_w, d)); }

// The triangle (a, a + e1, a + e2) projected onto the light from this lane's view sample, in homogeneous light
// coordinates. Edges come from edge vectors, so that small triangles keep their shape.
struct Seen {
  vec3 A, D1, D2;
  float from_a, far;                                      // from_a: |a − p|; far: bounds the distance of each corner
  float error_a;                                          // error of each coordinate of A, A + D1, A + D2 (bound W)
  float lowest, highest;                                  // smallest and largest W of the corners
  vec4 box;                                               // its place on the light (bound box)
};

// `sizes`: lengths of e1 and e2.
Seen see(vec3 a, vec3 e1, vec3 e2, vec2 sizes) {
  Seen seen;
  const vec3 d = a - p;
  seen.A = to_light(d);
  seen.D1 = to_light(e1);
  seen.D2 = to_light(e2);
  const vec3 B = seen.A + seen.D1, C = seen.A + seen.D2;
  seen.from_a = length(d);
  seen.far = seen.from_a + sizes.x + sizes.y;
  seen.error_a = 16.0 * kRound * r * seen.far;
  seen.lowest = min(seen.A.z, min(B.z, C.z));
  seen.highest = max(seen.A.z, max(B.z, C.z));
  const vec3 w = 1.0 / vec3(seen.A.z, B.z, C.z);
  const vec3 s = vec3(seen.A.x, B.x, C.x) * w, t = vec3(seen.A.y, B.y, C.y) * w;
  const vec2 lower = vec2(min(s.x, min(s.y, s.z)), min(t.x, min(t.y, t.z)));
  const vec2 upper = vec2(max(s.x, max(s.y, s.z)), max(t.x, max(t.y, t.z)));
  const float largest = max(max(-min(lower.x, lower.y), max(upper.x, upper.y)), 1.0);
  const float pad = (2.0 * seen.error_a * max(w.x, max(w.y, w.z)) + 8.0 * kRound) * (1.0 + largest) + light_pad;
  const bool bounded = seen.lowest > 8.0 * seen.error_a && light_pad < 1.0;
  seen.box = bounded ? vec4(lower - pad, upper + pad) : kWholeLight;
  return seen;
}

// Errors of ab, bc, ca (bound F).
vec3 error_of_edges(Seen seen, vec2 sizes) { return edge_error * seen.far * vec3(sizes.x, sizes.x + sizes.y, sizes.y) + kLeastError; }
// Returns whether p is certainly off the triangle's plane. (bound det)
bool has_side(float det, Seen seen, vec2 sizes) { return abs(det) > max(det_error * seen.from_a * sizes.x * sizes.y, kUnderflow); }

// Tests the pairs that float arithmetic decides, which are nearly all: the triangle lies between p and the light, p is
// off its plane, and no light sample is within the error of an edge. If this does not hold, returns false, having
// marked only certain results: `test_carefully` must repeat the test. The function is short, because some devices
// execute all of a loop's body regardless of its branches.
bool test_quickly(vec3 a, vec3 e1, vec3 e2, vec2 sizes, bool beyond) {
  const Seen seen = see(a, e1, e2, sizes);
  const vec3 ab = cross(seen.A, seen.D1), bc = cross(seen.A + seen.D1, seen.D2 - seen.D1), ca = cross(seen.D2, seen.A);
  const float det = dot(ab, seen.D2);
  const vec3 error = error_of_edges(seen, sizes);
  const bool missed = seen.highest < -seen.error_a || seen.box.x > 1.0 || seen.box.y > 1.0 || seen.box.z < -1.0 || seen.box.w < -1.0;
  const bool clear = beyond && seen.lowest > 8.0 * seen.error_a && has_side(det, seen, sizes);
  if (missed) return true;
  if (!clear) return false;
  const float sign = det < 0.0 ? -1.0 : 1.0, spacing = 2.0 / float(push.columns);
  const vec3 x = sign * vec3(ab.x, bc.x, ca.x), y = sign * vec3(ab.y, bc.y, ca.y), z = sign * vec3(ab.z, bc.z, ca.z);
  // Columns of a row as in mark_rows, for three edges: column k is at s = at.x + spacing · k.
  const vec3 slope = x * spacing;
  const bvec3 rising = greaterThanEqual(slope, vec3(0.0));
  const vec3 least = error / (16.0 * float(push.columns));
  const vec3 inverse = 1.0 / mix(min(slope, -least), max(slope, least), rising);
  const vec3 at_0 = -z * inverse, per_t = -y * inverse;
  const vec3 slack = 1.375 * error * abs(inverse) + float(push.columns) * (8.0 * kRound);
  // Added to an edge's crossing: gives a lower bound if the edge rises, an upper bound if it falls; the other bound is
  // infinite.
  const vec3 none = vec3(1e9);
  const vec3 sure_below = mix(-none, slack, rising), sure_above = mix(-slack, none, rising);
  const vec3 open_below = mix(-none, -slack, rising), open_above = mix(slack, none, rising);
  const float half_rows = 0.5 * float(push.rows), per_unit = 0.5 * float(push.columns), last_column = float(push.columns) - 1.0;
  const float box_from = seen.box.x * per_unit - 0.01, box_to = seen.box.z * per_unit + 0.01;
  const int first_row = max(int(ceil((max(seen.box.y, -1.0) + 1.0) * half_rows - 0.51)), 0);
  const int last_row = min(int(floor((min(seen.box.w, 1.0) + 1.0) * half_rows - 0.49)), int(push.rows) - 1);
  bool settled = true;
  for (int row = first_row; row <= last_row; ++row) {
    const vec2 at = row_start(row);
    const float start = at.x * per_unit;
    const vec3 k = at_0 + per_t * at.y - start;
    const vec3 sf = k + sure_below, st = k + sure_above, of = k + open_below, ot = k + open_above;
    const float sure_from = ceil(max(max(sf.x, sf.y), max(sf.z, 0.0)));
    const float sure_to = floor(min(min(st.x, st.y), min(st.z, last_column)));
    const float from = ceil(max(max(max(of.x, of.y), max(of.z, 0.0)), box_from - start));
    const float to = floor(min(min(min(ot.x, ot.y), min(ot.z, last_column)), box_to - start));
    const bool some = sure_from <= sure_to;
    settled = settled && (from > to || (some && from >= sure_from && to <= sure_to));
    if (kWordsPerRow == 1) {
      if (some) blocked[slot_of(uint(row))] |= bits(int(sure_from), int(sure_to));
    } else if (some) {
      for (int word = int(sure_from) >> 5; word <= int(sure_to) >> 5; ++word) {
        blocked[slot_of(uint(row) * kWordsPerRow + uint(word))] |= bits(max(int(sure_from) - 32 * word, 0), min(int(sure_to) - 32 * word, 31));
      }
    }
  }
  return settled;
}

// Tests all other cases: triangles that reach behind p or the light, p within rounding of the triangle's plane, light
// samples within the error of an edge.
void test_carefully(vec3 a, vec3 e1, vec3 e2, vec2 sizes, uint triangle, bool beyond) {
  const Seen seen = see(a, e1, e2, sizes);
  const vec4 box = seen.box;
  if (any(greaterThan(box.xy, vec2(1.0))) || any(lessThan(box.zw, vec2(-1.0)))) return;
  const bool between = beyond && seen.lowest > seen.error_a;
  const vec3 ab = cross(seen.A, seen.D1), bc = cross(seen.A + seen.D1, seen.D2 - seen.D1), ca = cross(seen.D2, seen.A);
  const float det = dot(ab, seen.D2);
  const vec3 error_f = error_of_edges(seen, sizes);
  const bool sided = has_side(det, seen, sizes);

  // An edge with the whole light on its outer side, for either orientation of the triangle, ends the test.
  const vec3 middle = vec3(ab.z, bc.z, ca.z);
  const vec3 span = abs(vec3(ab.x, bc.x, ca.x)) + abs(vec3(ab.y, bc.y, ca.y)) + error_f;
  bool positive = all(greaterThanEqual(middle + span, vec3(0.0)));
  bool negative = all(lessThanEqual(middle - span, vec3(0.0)));
  if (sided) {
    positive = positive && det > 0.0;
    negative = negative && det < 0.0;
  }
  if (!positive && !negative) return;

  vec3 fourth = kAlways;
  float fourth_error = kAlwaysError;
  if (!between) {
    // The light point must be on the other side of the triangle's plane than p: a fourth half-plane.
    const vec3 n = cross(e1, e2), from = push.center - a;
    fourth = orientation * vec3(dot(n, push.u), dot(n, push.v), dot(n, from));
    fourth_error = (64.0 * kRound * (size1(from) + size1(push.u) + size1(push.v)) + 2.0 * push.deviation) * sizes.x * sizes.y + kLeastError;
    // If p is within rounding of the triangle's plane, no result is certain.
    if (!sided) {
      fourth = vec3(0.0);
      fourth_error = 1.0;
    }
  }
  for (float sign = positive ? 1.0 : -1.0; ; sign = -1.0) {
    const float other = between ? 1.0 : sign;
    mark(HalfPlanes(vec4(sign * vec3(ab.x, bc.x, ca.x), other * fourth.x), vec4(sign * vec3(ab.y, bc.y, ca.y), other * fourth.y),
                    vec4(sign * middle, other * fourth.z), vec4(error_f, fourth_error)),
         box, triangle);
    if (sign < 0.0 || !negative) break;
  }
}

void main() {
  const uint chunk = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (chunk >= push.chunk_capacity) return;               // chunk_capacity is the number of chunks here
  const uint first = chunk * (kChunkHead + kChunk), header = chunks[first], outside_of = chunks[first + 1];
  const float side = (header & kBackBit) != 0 ? -1.0 : 1.0;
  load_view_sample(header & ~kBackBit);
  const uint words = (push.sample_count + 31) / 32;
  bool full = true;                                       // all samples are blocked already, by other chunks or the
                                                          // horizon
  for (uint word = 0; word < words && full; ++word) {
    full = masks[pixel * words + word] == 0;
  }
  // Factor 0.5: a compiler may round level_error differently here than in find_leaves, which asked the host. The host's
  // answer replaces results found here.
  const bool on = inside && carrier != kNone && level * side > 0.5 * level_error && !full;
  for (uint word = 0; word < kSharedWords; ++word) blocked[slot_of(word)] = 0;

  orientation = -side;
  row_s = orientation * cross(push.v, towards);
  row_t = orientation * cross(towards, push.u);
  row_w = orientation * cross(push.u, push.v);
  const float size = max(length(push.u), length(push.v));
  r = size * max(length(towards), size);
  const float volume = abs(level);
  light_pad = 4.0 * push.deviation * r / volume;
  edge_error = 176.0 * kRound * r * r + 2.0 * volume * push.deviation;
  det_error = 256.0 * kRound * r * r * size * size;

  // The slots of triangles that some lane could not decide quickly are kept, and tested again.
  const Shaft shaft = make_shaft(on, side);
  const vec3 lower = subgroupMin(on ? p : vec3(1e30)), upper = subgroupMax(on ? p : vec3(-1e30));
  const vec3 middle = 0.5 * lower + 0.5 * upper, half_size = 0.5 * upper - 0.5 * lower;
  const uint team = gl_SubgroupInvocationID / kTeam, member = gl_SubgroupInvocationID % kTeam;
  const uint end = kChunk * kTurns;
  uint at = subgroupAny(on) ? 0 : end;
  uint again_count = 0;
  for (; at < end; at += kTeams) {                        // the teams take one round of a leaf's slots after the other,
                                                          // leaf by leaf
    const uint number = at / kTurns + team, leaf = number < kChunk ? chunks[first + kChunkHead + number] : kNone;
    if (subgroupAll(leaf == kNone)) {
      at = end;
      break;
    }
    const uint slot = (leaf == kNone ? 0 : leaf) * kTeam + at % kTurns * kLanes + member;
    const Corners t = fetch(slot);
    const vec3 levels = vec3(dot(shaft.axis, t.a), dot(shaft.axis, t.b), dot(shaft.axis, t.c));
    const float nearest = min(levels.x, min(levels.y, levels.z));
    const vec4 least = min(shaft.nx * t.a.x + shaft.ny * t.a.y + shaft.nz * t.a.z,
                           min(shaft.nx * t.b.x + shaft.ny * t.b.y + shaft.nz * t.b.z, shaft.nx * t.c.x + shaft.ny * t.c.y + shaft.nz * t.c.z));
    const bool hit = leaf != kNone && t.triangle != kNone && t.light != push.light && nearest <= shaft.highest &&
                     max(levels.x, max(levels.y, levels.z)) >= shaft.lowest && all(lessThanEqual(least, shaft.beyond));
    const vec3 e1 = t.b - t.a, e2 = t.c - t.a;
    const vec2 sizes = vec2(length(e1), length(e2));
    // If all view samples are behind a triangle of a closed part, and outside of the part, another triangle of the part
    // hides everything that this one hides.
    const vec3 n = cross(e1, e2);
    const bool behind = dot(n, t.a - middle) - dot(abs(n), half_size) > 64.0 * kRound * push.reach * size1(e1) * size1(e2);
    const bool dispensable = behind && (outside_of >> t.part & 1) != 0;
    const uvec4 hits = subgroupBallot(hit && !dispensable), fronts = subgroupBallot(nearest > shaft.front);
    for (uint word = 0; word < (kLanes + 31) / 32; ++word) {
      for (uint left = hits[word]; left != 0; left &= left - 1) {
        const uint bit = uint(findLSB(left)), from = word * 32 + bit;
        const vec3 a = subgroupShuffle(t.a, from), e11 = subgroupShuffle(e1, from), e21 = subgroupShuffle(e2, from);
        const vec2 sizes1 = subgroupShuffle(sizes, from);
        const uint plane = subgroupShuffle(t.plane, from), front = fronts[word] >> bit & 1;
        bool settled = true;
        if (on && plane != carrier_plane) settled = kScatteredPoints == 0 && test_quickly(a, e11, e21, sizes1, front != 0);
        again[again_count] = subgroupShuffle(slot, from) | front << 31;  // every lane writes the same value
        again_count += subgroupAll(settled) ? 0 : 1;
      }
    }
  }
  uint i = 0;
  for (; i < again_count; ++i) {
    const uint slot = again[i] & 0x7fffffffu;
    const Corners t = fetch(slot);
    const vec3 e1 = t.b - t.a, e2 = t.c - t.a;
    if (on && t.plane != carrier_plane) test_carefully(t.a, e1, e2, vec2(length(e1), length(e2)), t.triangle, again[i] >> 31 != 0);
  }
  // Some drivers that run on processors end loops after 65535 iterations, which must be reported.
  if (at < end || i < again_count) atomicOr(asked.cut_off, 1u);
  if (on && !take_from_mask()) atomicOr(asked.cut_off, 1u);
}
