#version 460
#extension GL_GOOGLE_include_directive : require
#include "volumes/edge_scatter.glsl"

// Second pass of edge scatter, a workgroup a few neighbouring view samples (one a lane) and a band of light rows: how many
// triangles stand before each light sample. D at the light's lower left corner is counted triangle by triangle. From
// there it changes by ∓k_e(p) at each projected edge: up the light's left side, then along each row. Edges are scattered
// into a histogram [column][row] of such changes, in bytes; one running sum makes depths of them.
// Derivation, bounds and what becomes of light rows that rounding leaves open: docs/edge-scatter.md.

layout(constant_id = 2) const uint kGroupWidth = 4;       // pixels; its height is lanes / width
layout(constant_id = 3) const uint kColumns = 16;         // of light samples
layout(constant_id = 4) const uint kWordsPerColumn = 4;   // four light rows a word: rows of a band / 4
layout(constant_id = 5) const uint kHistogramWords = 64;  // a lane: columns · words a column

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
layout(scalar, binding = 12) buffer Masks { uint masks[]; };    // visible: 8 columns × 4 rows a word
layout(scalar, binding = 13) buffer Counts { uint counts[]; };  // visible light samples of a pixel
layout(scalar, binding = 14) writeonly buffer Questions { RowQuestion questions[]; };

// Some devices run a loop's body once even for no turn at all, and once more than a `for` asks: loops that count are
// written do … while, their bodies harmless where there is nothing to do.

shared uint histogram[kHistogramWords * kLanes];

// This lane's view sample.
ViewSample at;
vec3 from_center;
float away;                                               // |from_center|
int first_row, last_row;                                  // of the band
uint left_changes[kWordsPerColumn];                       // where edges cross the light's left side, a byte a row
uvec2 open_rows;                                          // light rows of the band for the host
uvec2 open_samples;                                       // and two more light samples, or kNone
bool open_pixel;                                          // all of them
bool cut_off;                                             // a loop did not run to its end
uint out_of_range;                                        // bytes of changes on the light's left side: open all rows

void open_row(float row, bool when) {
  const int bit = int(row) - first_row;
  if (when && bit >= 0 && row <= float(last_row)) {
    if (bit < 32) {
      open_rows.x |= 1u << bit;
    } else {
      open_rows.y |= 1u << (bit - 32);
    }
  }
}

float row_shift(int row) {
  return float(int((uint(row) * push.shift_step + 32768u) & 0xffffu) - 32768) / 65536.0;
}

// A light sample that is open. If there are more than two of the pixel, its row is.
void open_sample(float row, float column, bool when) {
  const uint light_sample = uint(int(row)) * kColumns + uint(int(column));
  const bool known = open_samples.x == light_sample || open_samples.y == light_sample;
  const bool full = when && !known && open_samples.x != kNone && open_samples.y != kNone;
  if (when && !known && !full) open_samples = open_samples.x == kNone ? uvec2(light_sample, open_samples.y) : uvec2(open_samples.x, light_sample);
  open_row(row, full);
}

// What is open where the changes at (row, x) may be anywhere within `error` of x: the nearest light sample, if it is that
// near; the row, if others are too, or if x may be on either side of where the row begins.
void open_near(float row, float x, float error, bool when) {
  const bool in_band = row >= float(first_row) && row <= float(last_row);
  const float column = x - row_shift(int(clamp(row, 0.0, float(push.rows - 1)))), nearest = round(column);
  const bool on_light = nearest >= 0.0 && nearest < float(kColumns);
  const bool wide = error >= 0.5 && column > -1.0 - error && column < float(kColumns) + error;
  open_row(row, when && in_band && (wide || abs(x + 0.5) < error));
  open_sample(row, nearest, when && in_band && !wide && on_light && abs(column - nearest) < error);
}

// p + d as p sees it: (across, along) · d and its height over p; it appears at foot + height / w (x, y).
vec3 seen_way(vec3 d) {
  precise const float w = -dot(axis, d);
  precise const vec2 way = vec2(dot(across, d), dot(along, d));
  return vec3(way, w);
}

vec2 appears(vec3 way) {
  precise const float q = at.height / way.z;
  precise const vec2 seen = at.foot + q * way.xy;
  return seen;
}

// The error of a projected point's coordinates in cells. (bound X)
float error_of(float far, float w, float height, float from_foot, float away) {
  const float q = height / w;
  return kRound * (4.0 * per_length * far * q + from_foot * (4.0 * far / w + 4.0 * away / height + 8.0) +
                   per_length * (4.0 * away + push.cut_reach) + 16.0 * skew * (half_cells.x + half_cells.y) * (1.0 + far / w)) +
         per_length * push.deviation;
}

// Adds one projected edge to the histogram, k times. `error_a`, `error_b`: of its ends' coordinates.
void scatter(vec2 a, vec2 b, int k, float error_a, float error_b) {
  k = push.side < 0.0 ? -k : k;                           // seen from behind, counter-clockwise is clockwise in (X, Y)
  // From the end nearer to the light's middle, so that far ends' errors, which grow with their distance, stay small.
  const vec2 to_a = abs(a - first_cell), to_b = abs(b - first_cell);
  const bool turn = to_b.x + to_b.y < to_a.x + to_a.y;
  const vec2 near = turn ? b : a, far = turn ? a : b;
  const float error_near = turn ? error_b : error_a, error_far = turn ? error_a : error_b;
  const int jump = (near.y < far.y) == turn ? k : -k;     // crossing the edge to the right, if it runs upward: −k
  const vec2 way = far - near, low = min(a, b), high = max(a, b);
  const float slope = way.x / way.y, steep = way.y == 0.0 ? 1e30 : abs(slope);

  // Ends within their error of a row: on which side they are is open, and so is what that row has there.
  const vec2 rows = vec2(round(near.y), round(far.y));
  open_near(rows.x, near.x, 1.2 * error_near * (1.0 + steep), abs(near.y - rows.x) < error_near);
  open_near(rows.y, far.x, 1.2 * error_far * (1.0 + steep), abs(far.y - rows.y) < error_far);

  // What the far end's error makes of a crossing on the light.
  const float weight = min(1.0, (abs(near.y - first_cell.y) + 2.0 * half_cells.y) / abs(way.y));
  const float error_x = 1.2 * (error_near + weight * error_far) * (1.0 + steep) + 8.0 * kRound * (half_cells.x + abs(near.x));

  int row = int(clamp(ceil(low.y), float(first_row), float(last_row + 1)));
  const int end = int(clamp(ceil(high.y), float(first_row), float(last_row + 1)));
  do {
    const bool crossed = row < end;
    const float x = clamp(near.x + (float(row) - near.y) * slope, low.x, high.x);
    const float column = x - row_shift(row), nearest = round(column);
    const bool counts = crossed && x >= -0.5;             // else it crosses left of the light
    const float first = max(ceil(column), 0.0);
    const bool lands = counts && first < float(kColumns);
    const bool open_one = crossed && abs(column - clamp(nearest, 0.0, float(kColumns) - 1.0)) < error_x;
    bool open = (open_one && error_x >= 0.5) || (crossed && abs(x + 0.5) < error_x);
    const uint band_row = uint(row - first_row);
    if (lands) {
      const uint word = (uint(first) * kWordsPerColumn + (band_row >> 2)) * kLanes + gl_SubgroupInvocationID;
      const int shift = int(band_row & 3) * 8;
      const uint old = histogram[word];
      const int changed = bitfieldExtract(int(old), shift, 8) + jump;
      open = open || abs(changed) > 63;                   // many layers at once
      histogram[word] = bitfieldInsert(old, uint(changed), shift, 8);
    }
    open_sample(float(row), nearest, open_one && error_x < 0.5);
    const uint bit = open ? 1u << (band_row & 31) : 0;
    open_rows |= band_row < 32 ? uvec2(bit, 0) : uvec2(0, bit);
  } while (++row < end);
  cut_off = cut_off || row < end;

  if ((a.x < -0.5) != (b.x < -0.5)) {
    const float inverse = way.y / way.x, flat_error = 1.2 * (error_near + error_far * min(1.0, (abs(near.x - first_cell.x) + 2.0 * half_cells.x) / abs(way.x))) * (1.0 + abs(inverse)) +
                          8.0 * kRound * (half_cells.y + abs(near.y));
    const float y = clamp(near.y + (-0.5 - near.x) * inverse, low.y, high.y);
    if (y > -0.5 - flat_error) {
      const float nearest = round(y);
      open_row(nearest, abs(y - nearest) < flat_error);
      if (abs(y + 0.5) < flat_error) open_pixel = true;
      const int from = max(int(min(ceil(y), 1e6)), first_row);
      if (y > -0.5 && from <= last_row) {
        const int up = (a.x < b.x) ? k : -k;              // crossing it upwards, if it runs to the right: +k
        const uint band_row = uint(from - first_row);
        const int shift = int(band_row & 3) * 8;
        const uint old = left_changes[band_row >> 2];
        const int changed = bitfieldExtract(int(old), shift, 8) + up;
        out_of_range |= uint(abs(changed) > 63);
        left_changes[band_row >> 2] = bitfieldInsert(old, uint(changed), shift, 8);
      }
    }
  }
}

// sgn(n · (p − anchor)); `open` if that is within its error.
int side_seen(vec3 p, vec3 n, vec3 anchor, inout bool open) {
  precise const vec3 d = p - anchor;
  precise const float f = dot(n, d);
  open = abs(f) <= 8.0 * kRound * dot(abs(n), abs(d)) && n != vec3(0.0);
  return f > 0.0 ? 1 : f < 0.0 ? -1 : 0;
}

// One edge, k times. Unless it stays well above p for the whole group (`settled`), what appears beyond a window of about
// twice the light is cut away, so that ends near p's height, or behind p, do not spoil what is in it. Where p is within
// rounding of one of the triangles' planes (`open`), that triangle is a sliver: samples it may hide are as near to its edges
// as if the edges were off their places by `sliver`. (bound window, bound sliver)
void scatter_seen(vec3 a, vec3 b, int k, bool open, bool settled, float sliver) {
  const vec3 da = a - at.p, db = b - at.p;
  const vec3 way_a = seen_way(da), way_b = seen_way(db);
  const vec2 window = 2.0 * half_cells + 2.0, xa = way_a.xy * at.height + (at.foot - first_cell) * way_a.z,
             xb = way_b.xy * at.height + (at.foot - first_cell) * way_b.z;
  const vec4 inside_a = vec4(window * way_a.z - xa, window * way_a.z + xa), inside_b = vec4(window * way_b.z - xb, window * way_b.z + xb);
  const vec4 t = inside_a / (inside_a - inside_b);
  const vec4 froms = mix(vec4(0.0), mix(t, vec4(2.0), lessThan(inside_b, vec4(0.0))), lessThan(inside_a, vec4(0.0)));
  const vec4 tos = mix(vec4(1.0), t, bvec4(ivec4(greaterThanEqual(inside_a, vec4(0.0))) * ivec4(lessThan(inside_b, vec4(0.0)))));
  const float from = settled ? 0.0 : max(max(froms.x, froms.y), max(froms.z, froms.w));
  const float to = settled ? 1.0 : min(min(tos.x, tos.y), min(tos.z, tos.w));
  const bool cut = from > 0.0 || to < 1.0;
  const vec3 start = from > 0.0 ? mix(way_a, way_b, from) : way_a, end = to < 1.0 ? mix(way_a, way_b, to) : way_b;
  const vec2 seen_a = appears(start), seen_b = appears(end);
  const float far_a = length(da), far_b = length(db), far = max(far_a, far_b);
  const float foot_a = length(seen_a - at.foot), foot_b = length(seen_b - at.foot), off = open ? sliver : 0.0;
  const float error_a = error_of(cut ? far : far_a, start.z, at.height, foot_a, away) + (at.height * per_length + foot_a) / start.z * off;
  const float error_b = error_of(cut ? far : far_b, end.z, at.height, foot_b, away) + (at.height * per_length + foot_b) / end.z * off;
  const bool matters = (k != 0 || open) && from <= to;
  const bool through_p = !settled && min(start.z, end.z) < 64.0 * kRound * far;
  if (matters && through_p) open_pixel = true;            // it passes through p, but for rounding
  if (matters && !through_p) scatter(seen_a, seen_b, k, error_a, error_b);
}

// The box of the group's view samples in each frame that edges are tested in.
struct GroupBounds {
  vec3 middle, half_size;
  vec2 foot_low, foot_high;
  float height_low, height_high, away;
};

GroupBounds bounds_of_group(bool on) {
  GroupBounds g;
  const vec3 lower = subgroupMin(on ? at.p : vec3(1e30)), upper = subgroupMax(on ? at.p : vec3(-1e30));
  g.middle = 0.5 * lower + 0.5 * upper;
  g.half_size = (0.5 * upper - 0.5 * lower) * (1.0 + 8.0 * kRound);
  g.foot_low = subgroupMin(on ? at.foot : vec2(1e30));
  g.foot_high = subgroupMax(on ? at.foot : vec2(-1e30));
  g.height_low = subgroupMin(on ? at.height : 1e30);
  g.height_high = subgroupMax(on ? at.height : 0.0);
  g.away = subgroupMax(on ? length(from_center) : 0.0);
  return g;
}

// Where x appears on the light for any view sample of the group: lower and upper (X, Y), if `bounded`. With h the height
// of x over the light's plane and H that of p, X' = X + (X − foot) h / (H − h): linear in both, so the corners bound it.
struct Range {
  vec2 low, high;
  bool bounded;
};

Range range_of(vec3 x, GroupBounds g) {
  const vec3 from = x - push.center;
  const vec2 above = vec2(dot(across, from), dot(along, from)) + first_cell;
  const float h = dot(axis, from), w_low = g.height_low - h, w_high = g.height_high - h;
  Range range;
  range.bounded = w_low > 0.25 * w_high && w_low > 256.0 * kRound * push.reach;
  const float at_low = h / w_low, at_high = h / w_high;
  const vec2 e0 = above - g.foot_high, e1 = above - g.foot_low;
  const vec2 p0 = e0 * at_low, p1 = e0 * at_high, p2 = e1 * at_low, p3 = e1 * at_high;
  const vec2 low = above + min(min(p0, p1), min(p2, p3)), high = above + max(max(p0, p1), max(p2, p3));
  const float far = length(x - g.middle) + length(g.half_size);
  const vec2 spread = max(abs(high - g.foot_low), abs(low - g.foot_high)) + (g.foot_high - g.foot_low);
  const float error = error_of(far, w_low, g.height_high, spread.x + spread.y, g.away);
  range.low = low - 4.0 * error;
  range.high = high + 4.0 * error;
  return range;
}

// Of one edge for each of the group's view samples, a bit a lane: k_e > 0, k_e < 0, |k_e| = 2, and whether rounding leaves
// it open.
struct Multiplicities {
  uvec2 positive, negative, two, open;
};

uvec2 bit_of(uint lane, bool set) {
  const uint bit = set ? 1u << (lane & 31) : 0;
  return kLanes <= 32 || lane < 32 ? uvec2(bit, 0) : uvec2(0, bit);
}
bool has_bit(uvec2 bits) { return ((kLanes <= 32 || gl_SubgroupInvocationID < 32 ? bits.x : bits.y) >> (gl_SubgroupInvocationID & 31) & 1) != 0; }

// One lane an edge, view sample after view sample.
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

const uint kQueue = 64;
uint queue[kQueue];                                       // edges; every lane has all of it: shared memory is the histogram's
uint queued;

// Projects and scatters the queued edges.
void drain(bool on, GroupBounds g) {
  const vec2 light_low = first_cell - half_cells, light_high = first_cell + half_cells;
  uint i = 0;
  for (; i < queued; i += kLanes) {
    // One lane an edge: can it matter to this group, and to which view samples?
    const bool used = i + gl_SubgroupInvocationID < queued;
    const int texel = int(used ? queue[i + gl_SubgroupInvocationID] : 0);
    const uvec4 t0 = texelFetch(record_a, texel), t1 = texelFetch(record_b, texel), t2 = texelFetch(record_n1, texel);
    const uvec4 t3 = texelFetch(record_anchor1, texel), t4 = texelFetch(record_n2, texel), t5 = texelFetch(record_anchor2, texel);
    const vec3 a = uintBitsToFloat(t0.xyz), b = uintBitsToFloat(t1.xyz);
    const Range at_a = range_of(a, g), at_b = range_of(b, g);
    const bool bounded = at_a.bounded && at_b.bounded;
    const vec2 low = min(at_a.low, at_b.low), high = max(at_a.high, at_b.high);
    const bool beside = any(greaterThan(low, light_high)) || any(lessThan(high, light_low));
    const bool crosses = low.x < -0.5 || floor(high.y) >= ceil(low.y);
    const bool behind = min(dot(axis, a - push.center), dot(axis, b - push.center)) > g.height_high + 128.0 * kRound * push.reach;
    const bool needed = used && !behind && !(bounded && (beside || !crosses));
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

// Edges of the list whose triangles the group does not see all alike go to the queue.
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
      cut_off = true;                                     // the loop above was
      break;
    }
    if (!room || piece == kNone) drain(on, g);
  }
  cut_off = cut_off || piece != kNone;
}

// How many triangles the segment from p to the light's lower left corner meets (Woop et al. 2013: in coordinates with the
// ray as third axis, what decides is three products in two dimensions).
// One is as good as many where no edge changes the count (`one_will_do`).
uint count_to_corner(uint head, bool on, bool one_will_do) {
  const vec4 none = vec4(-1e18);
  const Shaft shaft = make_shaft(-half_cells, -half_cells, subgroupMax(on ? slopes_of(-half_cells, -half_cells, at.foot, at.height) : none),
                                 subgroupMax(on ? at.height : 0.0));
  const vec2 lean = (first_cell - half_cells - at.foot) / at.height;  // the ray's way in cells for one unit of height
  uint met = 0;
  uint piece = head;
  for (; piece != kNone; piece = lists[piece]) {
    const uint count = lists[piece + 1];
    uint i = 0;
    for (; i < count && !(one_will_do && subgroupAll(!on || met > 0)); i += kLanes) {
      const bool used = i + gl_SubgroupInvocationID < count;
      const int texel = int(lists[piece + 2 + (used ? i + gl_SubgroupInvocationID : 0)]);
      const uvec4 t0 = texelFetch(corner_a, texel), t1 = texelFetch(corner_b, texel), t2 = texelFetch(corner_c, texel);
      const vec3 a = uintBitsToFloat(t0.xyz), b = uintBitsToFloat(t1.xyz), c = uintBitsToFloat(t2.xyz);
      const vec3 levels = vec3(dot(axis, a), dot(axis, b), dot(axis, c));
      const vec4 least = min(shaft.nx * a.x + shaft.ny * a.y + shaft.nz * a.z,
                             min(shaft.nx * b.x + shaft.ny * b.y + shaft.nz * b.z, shaft.nx * c.x + shaft.ny * c.y + shaft.nz * c.z));
      const bool hit = used && t0.w != kNone && t2.w != push.light && min(levels.x, min(levels.y, levels.z)) <= shaft.highest &&
                       max(levels.x, max(levels.y, levels.z)) >= shaft.lowest && all(lessThanEqual(least, shaft.beyond));
      const uvec4 hits = subgroupBallot(hit);
      for (uint word = 0; word < (kLanes + 31) / 32; ++word) {
        for (uint left = hits[word]; left != 0; left &= left - 1) {
          const uint from = word * 32 + uint(findLSB(left));
          const vec3 da = subgroupShuffle(a, from) - at.p, db = subgroupShuffle(b, from) - at.p, dc = subgroupShuffle(c, from) - at.p;
          const uint plane = subgroupShuffle(t1.w, from);
          const vec3 w = -vec3(dot(axis, da), dot(axis, db), dot(axis, dc));
          const vec2 xa = vec2(dot(across, da), dot(along, da)) - lean * w.x;
          const vec2 xb = vec2(dot(across, db), dot(along, db)) - lean * w.y;
          const vec2 xc = vec2(dot(across, dc), dot(along, dc)) - lean * w.z;
          const vec3 f = vec3(xa.x * xb.y - xa.y * xb.x, xb.x * xc.y - xb.y * xc.x, xc.x * xa.y - xc.y * xa.x);
          // (bound corner)
          const float far = max(length(da), max(length(db), length(dc)));
          const float lengths = away / at.height;
          const float error_x = kRound * far * (5.0 * per_length * (1.0 + lengths) + (8.0 + 5.0 * lengths) * length(lean));
          const float size = max(max(size1(vec3(xa, 0.0)), size1(vec3(xb, 0.0))), size1(vec3(xc, 0.0)));
          const float error = (2.0 * error_x + 4.0 * kRound * size) * size + 2.0 * error_x * error_x;
          const bool all_above = all(greaterThan(f, vec3(error))), all_below = all(lessThan(f, vec3(-error)));
          const bool passes = any(greaterThan(f, vec3(error))) && any(lessThan(f, vec3(-error)));
          // The height over p at which the line meets the triangle's plane: a mean of the corners', with weights f.
          const float total = f.x + f.y + f.z, at_meeting = (f.y * w.x + f.z * w.y + f.x * w.z) / total;
          const float error_w = 16.0 * kRound * (far + push.reach) + 6.0 * error * far / max(abs(total), 1e-30);
          const bool before_all = max(w.x, max(w.y, w.z)) < -16.0 * kRound * far;
          const bool beyond_all = min(w.x, min(w.y, w.z)) > at.height + 16.0 * kRound * (far + push.reach);
          const bool sure_within = (at_meeting > error_w && at_meeting < at.height - error_w) ||
                                   (min(w.x, min(w.y, w.z)) > 16.0 * kRound * far && max(w.x, max(w.y, w.z)) < at.height - 16.0 * kRound * (far + push.reach));
          const bool sure_without = passes || before_all || beyond_all || ((all_above || all_below) && (at_meeting < -error_w || at_meeting > at.height + error_w));
          if (on && plane != at.plane && !sure_without) {
            if ((all_above || all_below) && sure_within) {
              ++met;
            } else {
              open_pixel = true;
            }
          }
        }
      }
    }
    if (one_will_do && subgroupAll(!on || met > 0)) return met;
    cut_off = cut_off || i < count;
  }
  cut_off = cut_off || piece != kNone;
  return met;
}

uint bytes_sum(uint x, uint y) { return ((x & 0x7f7f7f7fu) + (y & 0x7f7f7f7fu)) ^ ((x ^ y) & 0x80808080u); }
// 0x01 in each byte that is 0.
uint zero_bytes(uint x) { return (~(((x & 0x7f7f7f7fu) + 0x7f7f7f7fu) | x) & 0x80808080u) >> 7; }

uint words_per_mask() { return (push.columns + 7) / 8 * ((push.rows + 3) / 4); }
uint mask_word(uint pixel, uint column_word, uint row_word) {
  return pixel * words_per_mask() + column_word * ((push.rows + 3) / 4) + row_word;
}

// Depths from changes; a light sample is visible where no triangle is before it.
uint count_visible(uint pixel, uint depth_at_corner, bool on) {
  int depth = int(depth_at_corner);
  uint visible = 0;
  const uint first_word = uint(first_row) >> 2;
  uint cells = 0;
  for (uint word = 0; word < kWordsPerColumn; ++word) {
    // Depths are in 0 … 127. More than that: 128 … 190, since none of the changes exceeds 63. Negative, −63 … −1, are those
    // of light samples that are open anyway.
    uint depths = 0, outside = 0;
    const uint changes = left_changes[word];
    for (int row = 0; row < 4; ++row) {
      depth += bitfieldExtract(int(changes), row * 8, 8);
      outside |= depth > 127 ? 0x80u << (row * 8) : 0;
      depths |= uint(depth & 0xff) << (row * 8);
    }
    const int rows_left = int(last_row) + 1 - first_row - int(word) * 4;
    const uint used = rows_left >= 4 ? 0x01010101u : rows_left <= 0 ? 0 : 0x01010101u & ((1u << (8 * rows_left)) - 1);
    for (uint column_word = 0; column_word * 8 < kColumns; ++column_word) {
      uint bits = 0;
      for (uint i = 0; i < 8; ++i) {
        const uint column = column_word * 8 + i;
        if (column < kColumns) {
          depths = bytes_sum(depths, histogram[(column * kWordsPerColumn + word) * kLanes + gl_SubgroupInvocationID]);
          outside |= depths & ~(depths << 1);
          bits |= (zero_bytes(depths) & used) << i;
          ++cells;
        }
      }
      visible += bitCount(bits);
      if (used != 0 && on) masks[mask_word(pixel, column_word, first_word + word)] = bits;
    }
    const uint rows = (outside >> 7 & 1) | (outside >> 14 & 2) | (outside >> 21 & 4) | (outside >> 28 & 8);
    const uint found = (rows & ((1u << clamp(rows_left, 0, 4)) - 1)) << (4 * (word & 7));
    open_rows |= word < 8 ? uvec2(found, 0) : uvec2(0, found);
  }
  cut_off = cut_off || cells != kHistogramWords;
  return visible;
}

// Light samples not strictly above the carrier's plane are not visible: A·X + B·Y + C > 0. (bound horizon)
uint cut_at_horizon(uint pixel, vec3 above, float error) {
  uint visible = 0, bits_seen = 0;
  for (int row = first_row; row <= last_row; row += 4) {
    for (uint column_word = 0; column_word * 8 < kColumns; ++column_word) {
      uint bits = masks[mask_word(pixel, column_word, uint(row) >> 2)];
      for (int i = 0; i < 32; ++i) {
        const int r = row + (i >> 3);
        const float column = float(column_word * 8 + uint(i & 7)) + row_shift(r);
        const vec2 light_point = (vec2(column, float(r)) - first_cell) / half_cells;
        const float value = above.x * light_point.x + above.y * light_point.y + above.z;
        if (value <= error) bits &= ~(1u << ((i >> 3) * 8 + (i & 7)));
        ++bits_seen;
        open_row(float(r), abs(value) <= error && column < float(kColumns) && r <= last_row);
      }
      masks[mask_word(pixel, column_word, uint(row) >> 2)] = bits;
      visible += bitCount(bits);
    }
  }
  cut_off = cut_off || bits_seen != uint((last_row - first_row + 4) / 4) * ((kColumns + 7) / 8) * 32;
  return visible;
}

void main() {
  make_frame();
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint group_height = kLanes / kGroupWidth, groups_across = kBlock / kGroupWidth, groups_per_block = kBlock * kBlock / kLanes;
  const uint band_rows = 4 * kWordsPerColumn, bands = (push.rows + band_rows - 1) / band_rows;
  const uint block = group / (groups_per_block * bands), band = group / groups_per_block % bands, member = group % groups_per_block;
  const uint blocks_across = (push.width + kBlock - 1) / kBlock;
  const uvec2 corner = uvec2(block % blocks_across, block / blocks_across) * kBlock +
                       uvec2(member % groups_across * kGroupWidth, member / groups_across * group_height);
  const uvec2 place = corner + uvec2(gl_SubgroupInvocationID % kGroupWidth, gl_SubgroupInvocationID / kGroupWidth);
  const bool inside = place.x < push.width && place.y < push.row_count;
  const uint pixel = inside ? place.y * push.width + place.x : 0;
  at = fetch_view_sample(pixel);
  from_center = at.p - push.center;
  away = length(from_center);
  first_row = int(band * band_rows);
  last_row = min(first_row + int(band_rows), int(push.rows)) - 1;
  for (uint word = 0; word < kWordsPerColumn; ++word) left_changes[word] = 0;
  open_rows = uvec2(0);
  open_samples = uvec2(kNone);
  open_pixel = false;
  out_of_range = 0;
  const uint all_samples = uint(last_row - first_row + 1) * kColumns;

  bool on = inside && at.carrier != kNone;
  const bool receives = on;
  // (2) p strictly on an emitting side of the light's plane. (bound level)
  const float error_level = level_error(at.p);
  if (on && abs(at.height) <= error_level) {
    open_pixel = push.side > 0.0;                         // one of two dispatches asks
    on = false;
  }
  const bool other_side = receives && at.height < -error_level;
  if (other_side) on = false;
  // (1) The light sample strictly above the carrier's plane: one half-plane of the light. (bound horizon)
  const vec3 towards = -from_center;
  const vec3 above = vec3(dot(at.normal, push.u), dot(at.normal, push.v), dot(at.normal, towards));
  const float error_above = 16.0 * kRound * (size1(towards) + size1(push.u) + size1(push.v) + size1(at.p)) + push.deviation;
  const float span = abs(above.x) + abs(above.y);
  const bool below = on && above.z + span < -error_above, straddles = on && !below && above.z - span <= error_above;
  if (below) on = false;

  uint visible = receives ? 0 : all_samples;
  const uint cluster = on ? heads[2 * kClusters * push.block_count + pixel] : kNone;
  uint depth = 0;
  cut_off = false;
  const bool any_edges = subgroupAny(on && heads[2 * (block * kClusters + (on ? cluster : 0))] != kNone);
  const uint cleared = any_edges || subgroupAny(straddles) ? kHistogramWords : 0;
  for (uint word = 0; word < cleared; ++word) histogram[word * kLanes + gl_SubgroupInvocationID] = 0;
  for (uint i = 0; i < kClusters; ++i) {
    const bool here = on && cluster == i;
    if (!subgroupAny(here)) continue;
    const uint edges = heads[2 * (block * kClusters + i)], triangles = heads[2 * (block * kClusters + i) + 1];
    if (triangles != kNone) {
      const uint met = count_to_corner(triangles, here, edges == kNone);
      if (here) depth = met;
    }
    if (edges != kNone) scatter_list(edges, here);
  }
  if (any_edges || subgroupAny(straddles)) {
    const uint counted = count_visible(pixel, depth, on);
    if (on) visible = counted;
    if (subgroupAny(straddles)) {
      if (straddles) visible = cut_at_horizon(pixel, above, error_above);
    }
  } else if (on) {
    visible = depth == 0 ? all_samples : 0;
  }
  if ((cut_off || out_of_range != 0) && on) open_pixel = true;
  if (open_pixel) visible = 0;                            // the host counts
  const bool mine = inside && !(other_side && push.keeps_rest != 0) && (receives || push.side > 0.0);
  if (mine && visible != 0) atomicAdd(counts[pixel], visible);
  if (!on) open_rows = uvec2(0);
  if (receives && (open_pixel || (open_rows.x | open_rows.y) != 0 || open_samples.x != kNone)) {
    const uint question = atomicAdd(question_count, 1);
    const int band = last_row + 1 - first_row;
    if (open_pixel) open_rows = uvec2(band >= 32 ? 0xffffffffu : (1u << band) - 1, band >= 64 ? 0xffffffffu : band > 32 ? (1u << (band - 32)) - 1 : 0);
    if (question < push.question_capacity) questions[question] = RowQuestion(pixel | (open_pixel ? kWholePixel : 0), uint(first_row), open_rows.x, open_rows.y, open_samples.x, open_samples.y);
  }
}
