// SPDX-License-Identifier: Apache-2.0
// Converts changes to depths, and depths to masks, for light samples in rows of a rectangle. Part of
// scatter_edges.comp. Bounds: docs/edge-scatter.md.

uint words_per_mask() { return (push.columns + 7) / 8 * ((push.rows + 3) / 4); }
uint mask_word(uint pixel, uint column_word, uint row_word) {
  return (push.first_pixel + pixel) * words_per_mask() + column_word * ((push.rows + 3) / 4) + row_word;
}

// Sums changes to depths; a light sample is visible where the depth is 0.
uint count_visible(uint pixel, uint depth_at_corner, bool on) {
  int depth = int(depth_at_corner);
  uint visible = 0;
  const uint first_word = uint(first_row) >> 2;
  uint cells = 0;
  for (uint word = 0; word < kWordsPerColumn; ++word) {
    // Valid depths are in 0 … 127. Since no change exceeds 63, a larger depth appears as 128 … 190. Negative depths,
    // −63 … −1, are those of light samples that are open anyway.
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

// Clears light samples that are not strictly above the carrier's plane: A·X + B·Y + C > 0. (bound horizon)
uint cut_at_horizon(uint pixel, vec3 above, float error) {
  uint visible = 0, bits_seen = 0;
  for (int row = first_row; row <= last_row; row += 4) {
    for (uint column_word = 0; column_word * 8 < kColumns; ++column_word) {
      uint bits = masks[mask_word(pixel, column_word, uint(row) >> 2)];
      for (int i = 0; i < 32; ++i) {
        const int r = row + (i >> 3);
        const uint column = column_word * 8 + uint(i & 7);
        const vec2 place = vec2(float(column) + row_shift(r), float(r)), light_point = (place - first_cell) / half_cells;
        const float value = above.x * light_point.x + above.y * light_point.y + above.z;
        if (value <= error) bits &= ~(1u << ((i >> 3) * 8 + (i & 7)));
        ++bits_seen;
        open_row(float(r), abs(value) <= error && column < kColumns && r <= last_row);
      }
      masks[mask_word(pixel, column_word, uint(row) >> 2)] = bits;
      visible += bitCount(bits);
    }
  }
  cut_off = cut_off || bits_seen != uint((last_row - first_row + 4) / 4) * ((kColumns + 7) / 8) * 32;
  return visible;
}
