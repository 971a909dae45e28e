// One edge as it appears to one view sample: what it changes, and what rounding leaves open because of it. Part of scatter_edges.comp.

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
                   per_length * 4.0 * away + 16.0 * skew * (half_cells.x + half_cells.y) * (1.0 + far / w)) +
         (per_length + from_foot / height) * push.deviation;
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

  // An outline that may pass the light's corner on either side, also along the left side: D is counted there.
  const float around = error_near + error_far, at_corner = clamp(near.x + (-0.5 - near.y) * slope, low.x, high.x);
  const bool holds_corner = all(lessThanEqual(low - around, vec2(-0.5))) && all(greaterThanEqual(high + around, vec2(-0.5)));
  if (holds_corner && !(abs(at_corner + 0.5) >= error_x)) open_pixel = true;

  // Where it crosses the left side. Should rounding put y on another side of a row, or of the corner, than that row's x, or
  // at_corner, is of the left side: then these are within error_x of it, and what is on that row, or all, is open. (bound left)
  if ((a.x < -0.5) != (b.x < -0.5)) {
    const float y = clamp(near.y + (-0.5 - near.x) * (way.y / way.x), low.y, high.y);
    if (y > -0.5 && y <= float(last_row)) {
      const int from = max(int(ceil(y)), first_row);
      const int up = (a.x < b.x) ? k : -k;                // crossing it upwards, if it runs to the right: +k
      const uint band_row = uint(from - first_row);
      const int shift = int(band_row & 3) * 8;
      const uint old = left_changes[band_row >> 2];
      const int changed = bitfieldExtract(int(old), shift, 8) + up;
      out_of_range |= uint(abs(changed) > 63);
      left_changes[band_row >> 2] = bitfieldInsert(old, uint(changed), shift, 8);
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
  const float far_a = length(da), far_b = length(db), far = max(far_a, far_b);
  const vec2 window = 2.0 * half_cells + 2.0, xa = way_a.xy * at.height + (at.foot - first_cell) * way_a.z,
             xb = way_b.xy * at.height + (at.foot - first_cell) * way_b.z;
  const vec2 cut_off_by = vec2(cut_far(at.height - way_a.z), cut_far(at.height - way_b.z));
  const float lift = lift_per_length * (far + max(cut_off_by.x, cut_off_by.y));
  const vec2 wide_a = window * (way_a.z + lift), wide_b = window * (way_b.z + lift);
  const vec4 inside_a = vec4(wide_a - xa, wide_a + xa), inside_b = vec4(wide_b - xb, wide_b + xb);
  const vec4 t = inside_a / (inside_a - inside_b);
  const vec4 froms = mix(vec4(0.0), mix(t, vec4(2.0), lessThan(inside_b, vec4(0.0))), lessThan(inside_a, vec4(0.0)));
  const vec4 tos = mix(vec4(1.0), t, bvec4(ivec4(greaterThanEqual(inside_a, vec4(0.0))) * ivec4(lessThan(inside_b, vec4(0.0)))));
  const float from = settled ? 0.0 : max(max(froms.x, froms.y), max(froms.z, froms.w));
  const float to = settled ? 1.0 : min(min(tos.x, tos.y), min(tos.z, tos.w));
  const bool cut = from > 0.0 || to < 1.0;
  const vec3 start = from > 0.0 ? mix(way_a, way_b, from) : way_a, end = to < 1.0 ? mix(way_a, way_b, to) : way_b;
  const vec2 seen_a = appears(start), seen_b = appears(end);
  const float foot_a = length(seen_a - at.foot), foot_b = length(seen_b - at.foot), off = open ? sliver : 0.0;
  const float far_start = (cut ? far : far_a) + (from > 0.0 ? mix(cut_off_by.x, cut_off_by.y, from) : cut_off_by.x);
  const float far_end = (cut ? far : far_b) + (to < 1.0 ? mix(cut_off_by.x, cut_off_by.y, to) : cut_off_by.y);
  const float error_a = error_of(far_start, start.z, at.height, foot_a, away) + (at.height * per_length + foot_a) / start.z * off;
  const float error_b = error_of(far_end, end.z, at.height, foot_b, away) + (at.height * per_length + foot_b) / end.z * off;
  const bool matters = (k != 0 || open) && from <= to;
  const float least = 64.0 * kRound;
  const bool through_p = !settled && (start.z < least * max(far, far_start) || end.z < least * max(far, far_end));
  if (matters && through_p) open_pixel = true;            // it passes through p within rounding
  side_in_doubt = side_in_doubt || open;
  if (matters && !through_p) scatter(seen_a, seen_b, k, error_a, error_b);
}
