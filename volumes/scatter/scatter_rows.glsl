// SPDX-License-Identifier: Apache-2.0
// Light samples in rows of a rectangle: changes by one edge, and samples that rounding leaves open. Part of
// scatter_edges.comp. Bounds: docs/edge-scatter.md.

layout(constant_id = 3) const uint kColumns = 16;         // columns of light samples
layout(constant_id = 4) const uint kWordsPerColumn = 4;   // four light rows in a word: rows of a band / 4

layout(scalar, binding = 14) buffer Questions {
  QuestionHead asked;
  RowQuestion questions[];
};

uint left_changes[kWordsPerColumn];                       // changes where edges cross the light's left side, a byte for
                                                          // each row
uvec2 open_rows;                                          // light rows of the band that the host decides
uvec2 open_samples;                                       // two more light samples that the host decides, or kNone

// Returns a mask of the first `count` of 64 rows.
uvec2 first_rows(int count) {
  return uvec2(count >= 32 ? 0xffffffffu : (1u << count) - 1, count >= 64 ? 0xffffffffu : count > 32 ? (1u << (count - 32)) - 1 : 0);
}

// Returns the rows of the band in which some triangle touches light samples.
uvec2 touched_rows() {
  uvec2 rows = uvec2(push.touched_low, push.touched_high);
  if (push.rows <= 64 && first_row >= 32) rows = uvec2(rows.y, 0);
  const int shift = first_row % 32;
  if (push.rows <= 64 && shift != 0) rows = uvec2(rows.x >> shift | rows.y << (32 - shift), rows.y >> shift);
  return rows & first_rows(last_row + 1 - first_row);
}

uint band_count() { return (push.rows + 4 * kWordsPerColumn - 1) / (4 * kWordsPerColumn); }

void begin_band(uint band) {
  const int band_rows = int(4 * kWordsPerColumn);
  first_row = int(band) * band_rows;
  last_row = min(first_row + band_rows, int(push.rows)) - 1;
  for (uint word = 0; word < kWordsPerColumn; ++word) left_changes[word] = 0;
  open_rows = uvec2(0);
  open_samples = uvec2(kNone);
}

uint samples_of_band() { return uint(last_row - first_row + 1) * kColumns; }

void open_touched() { open_rows = touched_rows(); }

// Asks the host about the pixel's open light samples.
void ask(uint pixel, bool on) {
  if (!on) open_rows = uvec2(0);
  if (!open_pixel && (open_rows.x | open_rows.y) == 0 && open_samples.x == kNone) return;
  const uint question = atomicAdd(asked.count, 1);
  const int band = last_row + 1 - first_row;
  if (open_pixel) open_rows = first_rows(band);
  if (question < push.question_capacity) questions[question] = RowQuestion((push.first_pixel + pixel) | (open_pixel ? kWholePixel : 0), uint(first_row), open_rows.x, open_rows.y, open_samples.x, open_samples.y);
}

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

// Records an open light sample. If the pixel has more than two, the whole row is recorded.
void open_sample(float row, float column, bool when) {
  const uint light_sample = uint(int(row)) * kColumns + uint(int(column));
  const bool known = open_samples.x == light_sample || open_samples.y == light_sample;
  const bool full = when && !known && open_samples.x != kNone && open_samples.y != kNone;
  if (when && !known && !full) open_samples = open_samples.x == kNone ? uvec2(light_sample, open_samples.y) : uvec2(open_samples.x, light_sample);
  open_row(row, full);
}

float row_shift(int row) {
  return float(int((uint(row) * push.shift_step + 32768u) & 0xffffu) - 32768) / 65536.0;
}

// Returns whether an edge that appears within these limits, and not outside of the light, may change the depth at some
// light sample.
bool may_change(vec2 low, vec2 high) { return low.x < -0.5 || floor(high.y) >= ceil(low.y); }

// Records the light samples left open by a change that may be anywhere within `error` of x in this row: the nearest
// sample, if it is that close; or the whole row, if other samples are that close, too, or if x may be on either side of
// the row's beginning.
void open_near(float row, float x, float error, bool when) {
  const bool in_band = row >= float(first_row) && row <= float(last_row);
  const float column = x - row_shift(int(clamp(row, 0.0, float(push.rows - 1)))), nearest = round(column);
  const bool on_light = nearest >= 0.0 && nearest < float(kColumns);
  const bool wide = error >= 0.5 && column > -1.0 - error && column < float(kColumns) + error;
  open_row(row, when && in_band && (wide || abs(x + 0.5) < error));
  open_sample(row, nearest, when && in_band && !wide && on_light && abs(column - nearest) < error);
}

void scatter(vec2 a, vec2 b, int k, float error_a, float error_b) {
  k = push.side < 0.0 ? -k : k;                           // seen from behind, counter-clockwise is clockwise in (X, Y)
  // Computes from the end nearer to the light's middle, so that the error of the far end, which grows with its
  // distance, has little effect.
  const vec2 to_a = abs(a - first_cell), to_b = abs(b - first_cell);
  const bool turn = to_b.x + to_b.y < to_a.x + to_a.y;
  const vec2 near = turn ? b : a, far = turn ? a : b;
  const float error_near = turn ? error_b : error_a, error_far = turn ? error_a : error_b;
  const int jump = (near.y < far.y) == turn ? k : -k;     // change of the depth to the right of the edge: −k if it runs
                                                          // upward
  const vec2 direction = far - near, low = min(a, b), high = max(a, b);
  const float slope = direction.x / direction.y, steep = direction.y == 0.0 ? 1e30 : abs(slope);

  // An end within its error of a row may be on either side of the row, which leaves the row open there.
  const vec2 rows = vec2(round(near.y), round(far.y));
  open_near(rows.x, near.x, 1.2 * error_near * (1.0 + steep), abs(near.y - rows.x) < error_near);
  open_near(rows.y, far.x, 1.2 * error_far * (1.0 + steep), abs(far.y - rows.y) < error_far);

  // Weight of the far end's error at a crossing on the light.
  const float weight = min(1.0, (abs(near.y - first_cell.y) + 2.0 * half_cells.y) / abs(direction.y));
  const float error_x = 1.2 * (error_near + weight * error_far) * (1.0 + steep) + 8.0 * kRound * (half_cells.x + abs(near.x));

  int row = int(clamp(ceil(low.y), float(first_row), float(last_row + 1)));
  const int end = int(clamp(ceil(high.y), float(first_row), float(last_row + 1)));
  do {
    const bool crossed = row < end;
    const float x = clamp(near.x + (float(row) - near.y) * slope, low.x, high.x);
    const float column = x - row_shift(row), nearest = round(column);
    const bool counts = crossed && x >= -0.5;             // else the edge crosses left of the light
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
      open = open || abs(changed) > 63;                   // many layers change there
      histogram[word] = bitfieldInsert(old, uint(changed), shift, 8);
    }
    open_sample(float(row), nearest, open_one && error_x < 0.5);
    const uint bit = open ? 1u << (band_row & 31) : 0;
    open_rows |= band_row < 32 ? uvec2(bit, 0) : uvec2(0, bit);
  } while (++row < end);
  cut_off = cut_off || row < end;

  // If a silhouette may pass the light's corner on either side, also along the left side, the pixel is open: D is
  // counted at that corner.
  const float around = error_near + error_far, at_corner = clamp(near.x + (-0.5 - near.y) * slope, low.x, high.x);
  const bool holds_corner = all(lessThanEqual(low - around, vec2(-0.5))) && all(greaterThanEqual(high + around, vec2(-0.5)));
  if (holds_corner && !(abs(at_corner + 0.5) >= error_x)) open_pixel = true;

  // Crossing of the left side. If rounding puts y on the wrong side of a row (or of the corner), then that row's x (or
  // at_corner) is within error_x of the left side, so that the row (or the whole pixel) is open. (bound left)
  if ((a.x < -0.5) != (b.x < -0.5)) {
    const float y = clamp(near.y + (-0.5 - near.x) * (direction.y / direction.x), low.y, high.y);
    if (y > -0.5 && y <= float(last_row)) {
      const int from = max(int(ceil(y)), first_row);
      const int up = (a.x < b.x) ? k : -k;                // change of the depth above the crossing: +k if the edge runs
                                                          // to the right
      const uint band_row = uint(from - first_row);
      const int shift = int(band_row & 3) * 8;
      const uint old = left_changes[band_row >> 2];
      const int changed = bitfieldExtract(int(old), shift, 8) + up;
      out_of_range |= uint(abs(changed) > 63);
      left_changes[band_row >> 2] = bitfieldInsert(old, uint(changed), shift, 8);
    }
  }
}
