// SPDX-License-Identifier: Apache-2.0
// Selects the edges of a list that affect the view samples of a subgroup, one lane for each edge, and scatters them.
// Part of scatter_edges.comp and scatter_points.comp.

// The box of the group's view samples, in each frame in which edges are tested.
struct GroupBounds {
  vec3 middle, half_size;
  vec3 in_grid_low, in_grid_high;                         // (across, along, axis) · (p - middle)
  vec2 foot_low, foot_high;
  float height_high, away;
};

vec3 grid_direction(vec3 d) { return vec3(dot(across, d), dot(along, d), dot(axis, d)); }

GroupBounds bounds_of_group(bool on) {
  GroupBounds g;
  const vec3 lower = subgroupMin(on ? at.p : vec3(1e30)), upper = subgroupMax(on ? at.p : vec3(-1e30));
  g.middle = 0.5 * lower + 0.5 * upper;
  g.half_size = (0.5 * upper - 0.5 * lower) * (1.0 + 8.0 * kRound);
  const vec3 in_grid = grid_direction(at.p - g.middle);
  g.in_grid_low = subgroupMin(on ? in_grid : vec3(1e30));
  g.in_grid_high = subgroupMax(on ? in_grid : vec3(-1e30));
  g.foot_low = subgroupMin(on ? at.foot : vec2(1e30));
  g.foot_high = subgroupMax(on ? at.foot : vec2(-1e30));
  g.height_high = subgroupMax(on ? at.height : 0.0);
  g.away = subgroupMax(on ? length(from_center) : 0.0);
  return g;
}

// Bounds of the place where x appears on the light from any view sample of the group: lower and upper (X, Y), valid if
// `bounded`. With h the height of x over the light's plane and H that of p, X' = X + (X − foot) h / (H − h). It is
// linear in X − foot and in h / (H − h), so the corners of both ranges bound it. X − foot and H − h are computed as
// differences from the group's middle, because h / (H − h) may be thousands, and the feet on the light are rounded.
struct Range {
  vec2 low, high;
  bool bounded;
};

Range range_of(vec3 x, GroupBounds g) {
  const vec3 from = x - push.center;
  const vec2 above = vec2(dot(across, from), dot(along, from)) + first_cell;
  const vec3 direction = grid_direction(x - g.middle);
  const float h = dot(axis, from), w_low = g.in_grid_low.z - direction.z, w_high = g.in_grid_high.z - direction.z;
  Range range;
  range.bounded = w_low > 0.25 * w_high && w_low > 256.0 * kRound * push.reach;
  const float at_low = h / w_low, at_high = h / w_high;
  const vec2 e0 = direction.xy - g.in_grid_high.xy, e1 = direction.xy - g.in_grid_low.xy;
  const vec2 p0 = e0 * at_low, p1 = e0 * at_high, p2 = e1 * at_low, p3 = e1 * at_high;
  const vec2 low = above + min(min(p0, p1), min(p2, p3)), high = above + max(max(p0, p1), max(p2, p3));
  const float far = length(x - g.middle) + length(g.half_size) + cut_far(h);
  const vec2 spread = max(abs(high - g.foot_low), abs(low - g.foot_high)) + (g.foot_high - g.foot_low);
  const float error = error_of(far, w_low, g.height_high, spread.x + spread.y, g.away);
  range.low = low - 4.0 * error;
  range.high = high + 4.0 * error;
  return range;
}

// An edge's multiplicities for each of the group's view samples, a bit for each lane: k_e > 0, k_e < 0, |k_e| = 2, and
// whether rounding leaves it open.
struct Multiplicities {
  uvec2 positive, negative, two, open;
};

uvec2 bit_of(uint lane, bool set) {
  const uint bit = set ? 1u << (lane & 31) : 0;
  return kLanes <= 32 || lane < 32 ? uvec2(bit, 0) : uvec2(0, bit);
}
bool has_bit(uvec2 bits) { return ((kLanes <= 32 || gl_SubgroupInvocationID < 32 ? bits.x : bits.y) >> (gl_SubgroupInvocationID & 31) & 1) != 0; }

// Computes one edge in each lane, view sample by view sample.
Multiplicities multiplicities(vec3 n1, vec3 anchor1, uint plane1, vec3 n2, vec3 anchor2, uint plane2, bool on) {
  Multiplicities m = Multiplicities(uvec2(0), uvec2(0), uvec2(0), uvec2(0));
  for (uint lane = 0; lane < kLanes; ++lane) {
    const vec3 p = subgroupShuffle(at.p, lane);
    const uint plane = subgroupShuffle(at.plane, lane);
    const bool is_on = subgroupShuffle(on, lane);
    bool open = false;
    const int side1 = side_seen(p, n1, anchor1, open) * int(plane1 != plane);
    const bool open1 = open && plane1 != plane;
    open = false;
    const int side2 = side_seen(p, n2, anchor2, open) * int(plane2 != plane);
    const int k = is_on ? side1 + side2 : 0;
    m.positive |= bit_of(lane, k > 0);
    m.negative |= bit_of(lane, k < 0);
    m.two |= bit_of(lane, abs(k) == 2);
    m.open |= bit_of(lane, is_on && (open1 || (open && plane2 != plane)));
  }
  return m;
}

const uint kQueue = kLanes > 32 ? 2 * kLanes : 64;        // must hold one more vote of the subgroup at any time
uint queue[kQueue];                                       // queued edges; every lane has a copy, since shared memory is
                                                          // used by the histogram
uint queued;

// Projects and scatters the queued edges.
void drain(bool on, GroupBounds g) {
  const vec2 light_low = first_cell - half_cells, light_high = first_cell + half_cells;
  uint i = 0;
  for (; i < queued; i += kLanes) {
    // Tests, one edge in each lane, whether the edge can affect this group, and which of its view samples.
    const bool used = i + gl_SubgroupInvocationID < queued;
    const int texel = int(used ? queue[i + gl_SubgroupInvocationID] : 0);
    const uvec4 t0 = texelFetch(record_a, texel), t1 = texelFetch(record_b, texel), t2 = texelFetch(record_n1, texel);
    const uvec4 t3 = texelFetch(record_anchor1, texel), t4 = texelFetch(record_n2, texel), t5 = texelFetch(record_anchor2, texel);
    const vec3 a = uintBitsToFloat(t0.xyz), b = uintBitsToFloat(t1.xyz);
    const Range at_a = range_of(a, g), at_b = range_of(b, g);
    const bool bounded = at_a.bounded && at_b.bounded;
    const vec2 low = min(at_a.low, at_b.low), high = max(at_a.high, at_b.high);
    const bool beside = any(greaterThan(low, light_high)) || any(lessThan(high, light_low));
    const bool behind = min(dot(axis, a - push.center), dot(axis, b - push.center)) > g.height_high + 128.0 * kRound * push.reach;
    const bool needed = used && !behind && !(bounded && (beside || !may_change(low, high)));
    const Multiplicities m = multiplicities(uintBitsToFloat(t2.xyz), uintBitsToFloat(t3.xyz), t0.w, uintBitsToFloat(t4.xyz),
                                            uintBitsToFloat(t5.xyz), t1.w, on);
    const float sliver = 16.0 * kRound * (max(length(uintBitsToFloat(t3.xyz) - g.middle), length(uintBitsToFloat(t5.xyz) - g.middle)) + length(g.half_size));
    const bool any_open = (m.open.x | m.open.y) != 0;
    const bool seen = any_open || (m.positive.x | m.positive.y | m.negative.x | m.negative.y) != 0;
    const bool settled = bounded && !any_open;
    const uvec4 all_needed = subgroupBallot(needed && seen);
    for (uint word = 0; word < (kLanes + 31) / 32; ++word) {
      uint left = all_needed[word];
      do {
        const uint from = word * 32 + (left != 0 ? uint(findLSB(left)) : 0);
        const bool positive = has_bit(subgroupShuffle(m.positive, from)), negative = has_bit(subgroupShuffle(m.negative, from));
        const bool open = has_bit(subgroupShuffle(m.open, from)) && left != 0;
        const int size = has_bit(subgroupShuffle(m.two, from)) ? 2 : 1, k = left == 0 ? 0 : positive ? size : negative ? -size : 0;
        const vec3 a1 = subgroupShuffle(a, from), b1 = subgroupShuffle(b, from);
        scatter_seen(a1, b1, k, open && on, subgroupShuffle(settled, from), subgroupShuffle(sliver, from));
        left &= left - 1;
      } while (left != 0);
      cut_off = cut_off || left != 0;
    }
  }
  cut_off = cut_off || i < queued;
  queued = 0;
}

// Queues edges of the list unless the whole group sees their triangles from the same side.
void scatter_list(uint head, bool on) {
  const GroupBounds g = bounds_of_group(on);
  queued = 0;
  uint i = 0, piece = head;
  uint count = piece == kNone ? 0 : lists[piece + 1];
  while (piece != kNone) {
    for (; i < count && queued + kLanes < kQueue; i += kLanes) {
      const bool used = i + gl_SubgroupInvocationID < count;
      const uint slot = lists[piece + 2 + (used ? i + gl_SubgroupInvocationID : 0)];
      const int texel = int(slot);
      const uvec4 t2 = texelFetch(record_n1, texel), t3 = texelFetch(record_anchor1, texel);
      const uvec4 t4 = texelFetch(record_n2, texel), t5 = texelFetch(record_anchor2, texel);
      const int side1 = side_for_all(uintBitsToFloat(t2.xyz), uintBitsToFloat(t3.xyz), g.middle, g.half_size);
      const int side2 = side_for_all(uintBitsToFloat(t4.xyz), uintBitsToFloat(t5.xyz), g.middle, g.half_size);
      const bool silhouette = used && (side1 == 2 || side2 == 2 || side1 + side2 != 0);
      const uvec4 all_silhouettes = subgroupBallot(silhouette);
      for (uint word = 0; word < (kLanes + 31) / 32; ++word) {
        uint left = all_silhouettes[word];
        do {
          queue[queued] = subgroupShuffle(slot, word * 32 + (left != 0 ? uint(findLSB(left)) : 0));
          queued += left != 0 ? 1 : 0;
          left &= left - 1;
        } while (left != 0);
        cut_off = cut_off || left != 0;
      }
    }
    const bool room = queued + kLanes < kQueue;
    if (i >= count) {
      piece = lists[piece];
      i = 0;
      count = piece == kNone ? 0 : lists[piece + 1];
    } else if (room) {
      cut_off = true;                                     // the loop above was cut off
      break;
    }
    if (!room || piece == kNone) drain(on, g);
  }
  cut_off = cut_off || piece != kNone;
}
