#version 460
#extension GL_GOOGLE_include_directive : require
#include "vsm/view_sample.glsl"

// Second pass of view-sample mapping: for every (view sample, triangle) pair the set of light samples that the triangle
// hides, OR-ed (Eisemann-Décoret 2007; Sintorn et al. 2008). Departing from the papers, nothing is decided by rounding:
// the plane of each edge has an error bound, what lies within it is put down as an open question, and the host answers
// that with exact predicates.

layout(binding = 5) uniform usamplerBuffer corner_a;      // per leaf slot: (a, triangle)
layout(binding = 6) uniform usamplerBuffer corner_b;      // (b, plane)
layout(binding = 7) uniform usamplerBuffer corner_c;      // (c, light that it is the body of)

float orientation;                                        // ±1: makes W positive on the way to the light
vec3 row_s, row_t, row_w;                                 // d ↦ (S, T, W): the light point (S/W, T/W) lies behind d
float r;                                                  // R = max(|u|, |v|) · max(|c − p|, |u|, |v|)
float volume;                                             // |(u × v)·(c − p)|

vec3 to_light(vec3 d) { return vec3(dot(row_s, d), dot(row_t, d), dot(row_w, d)); }

// Does this lane's view sample lose light to the triangle (a, a + e1, a + e2)? `edge` is |e1| + |e2| in the 1-norm;
// `beyond`: the triangle is strictly on the view sample's side of the light's plane.
void test(vec3 a, vec3 e1, vec3 e2, float edge, uint triangle, bool beyond) {
  const vec3 d = a - p;
  // Homogeneous light coordinates of the corners; edges from edge vectors, so that small triangles keep their shape.
  const vec3 A = to_light(d), D1 = to_light(e1), D2 = to_light(e2);
  const vec3 B = A + D1, C = A + D2, D3 = D2 - D1;
  const float far = size1(d) + edge, r2 = r * r;

  // (bound W) All corners strictly between p's and the light's parallel planes?
  const float error_a = 16.0 * kRound * r * far;          // of A, B, C, each coordinate
  const float lowest = min(A.z, min(B.z, C.z));
  const bool between = beyond && lowest > error_a;
  vec4 box = kWholeLight;
  if (lowest > 8.0 * error_a) {                           // (bound box)
    const vec3 w = 1.0 / vec3(A.z, B.z, C.z);
    const vec3 s = vec3(A.x, B.x, C.x) * w, t = vec3(A.y, B.y, C.y) * w;
    const vec2 lower = vec2(min(s.x, min(s.y, s.z)), min(t.x, min(t.y, t.z)));
    const vec2 upper = vec2(max(s.x, max(s.y, s.z)), max(t.x, max(t.y, t.z)));
    const float largest = max(max(-min(lower.x, lower.y), max(upper.x, upper.y)), 1.0);
    const float pad = (2.0 * error_a * max(w.x, max(w.y, w.z)) + 8.0 * kRound) * (1.0 + largest) + 2.0 * push.deviation * r / volume;
    box = vec4(lower - pad, upper + pad);
    if (any(greaterThan(box.xy, vec2(1.0))) || any(lessThan(box.zw, vec2(-1.0)))) return;
  }

  const vec3 ab = cross(A, D1), bc = cross(B, D3), ca = cross(D2, A);
  const float det = dot(ab, D2);
  // (bound F) and (bound det)
  const float error_f = (256.0 * kRound * r2 + 2.0 * volume * push.deviation) * far * edge;
  const bool one_way = abs(det) > 256.0 * kRound * r2 * r * far * edge * edge;

  // An edge that has the whole light on its outer side, whichever way round the triangle is, ends it here.
  const vec3 middle = vec3(ab.z, bc.z, ca.z);
  const vec3 span = abs(vec3(ab.x, bc.x, ca.x)) + abs(vec3(ab.y, bc.y, ca.y)) + error_f;
  bool positive = all(greaterThanEqual(middle + span, vec3(0.0)));
  bool negative = all(lessThanEqual(middle - span, vec3(0.0)));
  if (one_way) {
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
    fourth_error = (64.0 * kRound * (size1(from) + size1(push.u) + size1(push.v)) + 2.0 * push.deviation) * edge * edge;
    if (!one_way) {                                       // p is within rounding of the triangle's plane: never certain
      fourth = vec3(0.0);
      fourth_error = 1.0;
    }
  }
  for (float sign = positive ? 1.0 : -1.0; ; sign = -1.0) {
    const float other = between ? 1.0 : sign;
    mark(HalfPlanes(vec4(sign * vec3(ab.x, bc.x, ca.x), other * fourth.x), vec4(sign * vec3(ab.y, bc.y, ca.y), other * fourth.y),
                    vec4(sign * middle, other * fourth.z), vec4(vec3(error_f), fourth_error)),
         box, triangle);
    if (sign < 0.0 || !negative) break;
  }
}

void main() {
  const uint chunk = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (chunk >= push.chunk_capacity) return;               // here: how many there are
  const uint first = chunk * (1 + kChunk), header = chunks[first];
  const float side = (header & kBackBit) != 0 ? -1.0 : 1.0;
  load_view_sample(header & ~kBackBit);
  const uint words = (push.sample_count + 31) / 32;
  bool full = true;                                       // nothing left to block: other chunks or the horizon did
  for (uint word = 0; word < words && full; ++word) {
    full = masks[pixel * words + word] == bits(0, int(min(push.sample_count - 32 * word, 32)) - 1);
  }
  const bool on = inside && carrier != kNone && level * side > level_error && !full;
  for (uint word = 0; word < kSharedWords; ++word) blocked[slot_of(word)] = 0;

  orientation = -side;
  row_s = orientation * cross(push.v, towards);
  row_t = orientation * cross(towards, push.u);
  row_w = orientation * cross(push.u, push.v);
  const float size = max(length(push.u), length(push.v));
  r = size * max(length(towards), size);
  volume = abs(level);

  const Shaft shaft = make_shaft(on, side);
  const uint teams = kLanes / kTeam, team = gl_SubgroupInvocationID / kTeam, member = gl_SubgroupInvocationID % kTeam;
  uint at = subgroupAny(on) ? 0 : kChunk;
  for (; at < kChunk; at += teams) {
    const uint leaf = at + team < kChunk ? chunks[first + 1 + at + team] : kNone;
    if (subgroupAll(leaf == kNone)) {
      at = kChunk;
      break;
    }
    const int slot = int((leaf == kNone ? 0 : leaf) * kTeam + member);
    const uvec4 ta = texelFetch(corner_a, slot), tb = texelFetch(corner_b, slot), tc = texelFetch(corner_c, slot);
    const vec3 a = uintBitsToFloat(ta.xyz), b = uintBitsToFloat(tb.xyz), c = uintBitsToFloat(tc.xyz);
    const vec3 levels = vec3(dot(shaft.axis, a), dot(shaft.axis, b), dot(shaft.axis, c));
    const float nearest = min(levels.x, min(levels.y, levels.z));
    const vec4 least = min(shaft.nx * a.x + shaft.ny * a.y + shaft.nz * a.z,
                           min(shaft.nx * b.x + shaft.ny * b.y + shaft.nz * b.z, shaft.nx * c.x + shaft.ny * c.y + shaft.nz * c.z));
    const bool hit = leaf != kNone && ta.w != kNone && int(tc.w) != push.light && nearest <= shaft.highest &&
                     max(levels.x, max(levels.y, levels.z)) >= shaft.lowest && all(lessThanEqual(least, shaft.beyond));
    const vec3 e1 = b - a, e2 = c - a;
    const float edge = size1(e1) + size1(e2);
    const uvec4 hits = subgroupBallot(hit), fronts = subgroupBallot(nearest > shaft.front);
    for (uint word = 0; word < (kLanes + 31) / 32; ++word) {
      for (uint left = hits[word]; left != 0; left &= left - 1) {
        const uint from = word * 32 + uint(findLSB(left));
        const vec3 a1 = subgroupShuffle(a, from), e11 = subgroupShuffle(e1, from), e21 = subgroupShuffle(e2, from);
        const float edge1 = subgroupShuffle(edge, from);
        const uint triangle = subgroupShuffle(ta.w, from), plane = subgroupShuffle(tb.w, from);
        if (on && plane != carrier_plane) test(a1, e11, e21, edge1, triangle, (fronts[word] >> (from & 31) & 1) != 0);
      }
    }
  }
  // Some processors' drivers end loops after 65535 turns. Never go on as if nothing had happened.
  if (at < kChunk) atomicOr(unfinished, kTestCut);
  if (on) add_to_mask();
}
