// SPDX-License-Identifier: Apache-2.0
// Arbitrary light samples, in rows (point_rows.hpp): changes by one edge, and samples that rounding leaves open. Part
// of scatter_points.comp. Bounds: docs/edge-scatter.md.
#include "volumes/scatter/point_rows.shared.h"

layout(constant_id = 3) const uint kFours = 4;            // number of slots of a row, divided by four
layout(constant_id = 4) const uint kBandRows = 16;        // a multiple of kPointRowsAtOnce

layout(scalar, binding = 14) buffer Questions {
  QuestionHead asked;
  PointQuestion questions[];
};
// Places of each four slots of a row, in cells: their x, then their y. Light samples are stored from left to right;
// slots without a light sample follow.
layout(scalar, binding = 15) readonly buffer Places { vec4 places[]; };
// For each row, and each place along it from left to right: the four slots with the first light sample at or after that
// place.
layout(scalar, binding = 16) readonly buffer Starts { uint starts[]; };
// A bit for each slot, in words of masks: whether it is a light sample, and whether some triangle touches that sample.
layout(scalar, binding = 17) readonly buffer Slots { uvec2 slots[]; };

// A lane's words in the histogram: a byte for each slot, the change from this slot on to the end of its row; a byte for
// each row, the change of this row and all above it; a bit for each open slot.
const uint kChanges = kBandRows * kFours, kMaskWords = kChanges / 8, kLeftWord = kChanges, kOpenWord = kLeftWord + kBandRows / 4;
const float kBeyond = 1e29;                               // x of slots without light sample

int corner_change;                                        // change at the light's corner

uint lane_word(uint word) { return word * kLanes + gl_SubgroupInvocationID; }
uint band_count() { return (push.rows + kBandRows - 1) / kBandRows; }
uint first_word() { return uint(first_row) * kFours / 8; }

void begin_band(uint band) {
  first_row = int(band * kBandRows);
  last_row = min(first_row + int(kBandRows), int(push.rows)) - 1;
  corner_change = 0;
}

uint samples_of_band() {
  uint count = 0;
  for (uint word = 0; word < kMaskWords; ++word) count += bitCount(slots[first_word() + word].x);
  return count;
}

void open_touched() {
  for (uint word = 0; word < kMaskWords; ++word) histogram[lane_word(kOpenWord + word)] = slots[first_word() + word].y;
}

void ask_about(uint pixel, uint word, uint bits, uint words) {
  const uint question = atomicAdd(asked.count, 1);
  const uint whole = open_pixel ? kWholePixel : 0;
  if (question < push.question_capacity) questions[question] = PointQuestion((push.first_pixel + pixel) | whole, first_word() + word, bits, words, 0, 0);
}

// Asks the host about the pixel's open light samples. `listed`: the histogram has the open samples. If a driver ends
// the loop, all samples are open: this question needs no loop.
void ask(uint pixel, bool listed) {
  uint word = 0;
  if (listed && !open_pixel) {
    do {
      const uint bits = histogram[lane_word(kOpenWord + word)] & slots[first_word() + word].x;
      if (bits != 0) ask_about(pixel, word, bits, 1);
    } while (++word < kMaskWords);
    open_pixel = word < kMaskWords;
  }
  if (open_pixel) ask_about(pixel, 0, 0, kMaskWords);
}

// Every edge counts: even a short one may pass a light sample.
bool may_change(vec2 low, vec2 high) { return true; }

// Returns twice the area between the three points: > 0 if x is right of the line from `low` along `direction`, which points
// upward.
float side_of(vec2 x, vec2 low, vec2 direction) { return (x.x - low.x) * direction.y - (x.y - low.y) * direction.x; }

// Adds to bytes, and records bytes that may overflow: valid changes are in −63 … 63.
void add_bytes(uint word, uint by) {
  const uint changed = bytes_sum(histogram[lane_word(word)], by);
  histogram[lane_word(word)] = changed;
  out_of_range |= bytes_sum(changed, 0x40404040u) & 0x80808080u;
}

// Adds a change to all rows from height y on.
void change_left(float y, int by, bool when) {
  const int from = int(clamp(ceil(y), float(first_row), float(last_row + 1)));
  const uint band_row = uint(min(from, last_row) - first_row);
  add_bytes(kLeftWord + band_row / 4, when && from <= last_row ? uint(by & 0xff) << (band_row % 4 * 8) : 0);
}

// Adds one projected edge with multiplicity k. The path to a light sample runs from the light's corner up its left side
// to the middle of the sample's row, along the row to the place under or over the light sample, and vertically to it.
// Its last part crosses only edges that span the light sample's x.
void scatter(vec2 a, vec2 b, int k, float error_a, float error_b) {
  k = push.side < 0.0 ? -k : k;                           // seen from behind, counter-clockwise is clockwise in (X, Y)
  const bool up = a.y < b.y;
  const vec2 low = up ? a : b, high = up ? b : a, direction = high - low, size = abs(direction);
  const int jump = up ? -k : k;                           // change of the depth to the right of the edge
  const float left = min(low.x, high.x), right = max(low.x, high.x);

  // The farther end's error counts by the fraction of the edge that is on the light. (bound side of a point)
  const vec2 to_a = abs(a - first_cell), to_b = abs(b - first_cell);
  const bool turn = to_b.x + to_b.y < to_a.x + to_a.y;
  const vec2 from_middle = turn ? to_b : to_a;
  const float error_near = turn ? error_b : error_a, error_far = turn ? error_a : error_b, extent = max(size.x, size.y);
  const float reached = (size.y > size.x ? from_middle.y + half_cells.y : from_middle.x + half_cells.x) + error_near;
  const float weight = error_far < 0.5 * extent ? min(1.0, 2.0 * reached / extent) : 1.0;
  const float around = 1.2 * max(error_near, error_far), aside = 1.2 * (error_near + weight * error_far);
  const float near = aside * (size.x + size.y) + 16.0 * kRound * size.x * size.y;
  const vec2 low_near = vec2(left, low.y) - around, high_near = vec2(right, high.y) + around;
  if (any(lessThan(high_near, vec2(-0.5))) || any(greaterThan(low_near, first_cell + half_cells))) return;

  // Handles the light's corner, where changes begin; and the part left of the light, as if the edge continued straight
  // to the left.
  const float corner_side = side_of(vec2(-0.5), low, direction);
  if (all(lessThanEqual(low_near, vec2(-0.5))) && !(abs(corner_side) > near)) open_pixel = true;
  const bool corner_is_right = right <= -0.5 || (left <= -0.5 && corner_side > 0.0);
  corner_change += low.y <= -0.5 && high.y > -0.5 && corner_is_right ? jump : 0;
  corner_change += high.x < -0.5 && high.y <= -0.5 ? jump : 0;
  corner_change -= low.x < -0.5 && low.y <= -0.5 ? jump : 0;
  change_left(high.y, jump, high.x < -0.5);
  change_left(low.y, -jump, low.x < -0.5);

  // An edge flatter than this may be next to any light sample of a row. (bound side of a point)
  const bool leans = size.y > 1e-6 * size.x;
  const float slope = leans ? direction.x / direction.y : 0.0;
  const float beside = leans ? aside * (1.0 + abs(slope)) + 16.0 * kRound * (abs(low.x) + size.x) : 1e30;
  int row = int(clamp(ceil(low_near.y - 0.5), float(first_row), float(last_row + 1)));
  const int end = int(clamp(floor(high_near.y + 0.5) + 1.0, float(first_row), float(last_row + 1)));
  uint four = kNone;                                      // the next four slots of this row
  int before = 0;                                         // how often the changes up to here include the jump
  do {
    const bool on = row < end;
    const float middle = float(row), bottom = max(middle - 0.5, low_near.y), top = min(middle + 0.5, high_near.y);
    // Left of `from` nothing changes; right of `until` all of the row's light samples are on one side.
    const float at_bottom = low.x + (bottom - low.y) * slope, at_top = low.x + (top - low.y) * slope;
    const float from = max(low_near.x, min(at_bottom, at_top) - beside), until = min(high_near.x, max(at_bottom, at_top) + beside);
    const uint in_row = uint(min(row, int(push.rows) - 1)), row_starts = push.columns * kStartsPerCell;
    const uint start = min(uint(max((from + 0.5) * float(kStartsPerCell), 0.0)), row_starts - 1);
    four = four == kNone ? starts[in_row * row_starts + start] : four;
    const uint place = 2 * (in_row * kFours + four);
    const vec4 x = places[place], y = places[place + 1];
    const vec4 side = (x - low.x) * direction.y - (y - low.y) * direction.x;
    const bool spans = low.y <= middle && middle < high.y;
    // `bend` is 1 if the place on the row's middle under or over a light sample is right of the edge. This does not
    // matter if the edge crosses the middle: its change before that place is reverted after it.
    const int bend = !spans && (middle < low.y) == (direction.x > 0.0) ? 1 : 0;
    uint changes = 0, near_bits = 0;
    for (uint i = 0; i < kPointsAtOnce; ++i) {
      const bool is_right = y[i] >= high.y ? direction.x < 0.0 : y[i] < low.y ? direction.x > 0.0 : side[i] > 0.0;
      const int now = x[i] >= kBeyond ? before : x[i] >= right ? int(spans) : x[i] >= left ? int(is_right) - bend : 0;
      changes |= uint((now - before) * jump & 0xff) << (8 * i);
      before = now;
      const bool in_box = x[i] >= low_near.x && x[i] <= high_near.x && y[i] >= low_near.y && y[i] <= high_near.y;
      near_bits |= in_box && !(abs(side[i]) > near) ? 1u << i : 0;
    }
    const uint in_band = uint(min(row, last_row) - first_row) * kFours + four;
    add_bytes(in_band, on ? changes : 0);
    histogram[lane_word(kOpenWord + in_band / 8)] |= on ? near_bits << (4 * (in_band % 8)) : 0u;
    ++four;
    const bool done = four >= kFours || x.w > until;
    before = done ? 0 : before;
    four = done ? kNone : four;
    row += done ? 1 : 0;
  } while (row < end);
  cut_off = cut_off || row < end;
}
