// SPDX-License-Identifier: Apache-2.0
// Converts changes to depths, and depths to masks, for arbitrary light samples. Part of scatter_points.comp. Bounds:
// docs/edge-scatter.md.

uint mask_word(uint pixel, uint word) { return (push.first_pixel + pixel) * (band_count() * kMaskWords) + first_word() + word; }

// Sums changes to depths; a light sample is visible where the depth is 0.
uint count_visible(uint pixel, uint depth_at_corner, bool on) {
  uint visible = 0, in_row = 0, row = 0, word = 0, depths = 0, outside = 0;
  int left = int(depth_at_corner) - corner_change;        // the depth at the beginning of the row
  do {
    uint bits = 0;
    for (uint i = 0; i < 8; ++i) {
      if (in_row == 0) {
        left += bitfieldExtract(int(histogram[lane_word(kLeftWord + row / 4)]), int(row % 4 * 8), 8);
        outside |= left > 127 || left < -127 ? 1u : 0;
        depths = uint(left & 0xff) << 24;
        ++row;
      }
      // Valid depths are in 0 … 127. Since no change exceeds 63, a larger depth appears as 128 … 190. Negative depths,
      // −63 … −1, are those of light samples that are open anyway.
      uint sums = histogram[lane_word(word * 8 + i)];
      sums = bytes_sum(sums, sums << 8);
      sums = bytes_sum(sums, sums << 16);
      depths = bytes_sum(sums, (depths >> 24) * 0x01010101u);
      outside |= depths & ~(depths << 1) & 0x80808080u;
      bits |= (zero_bytes(depths) * 0x10204080u >> 28) << (4 * i);
      in_row = in_row + 1 == kFours ? 0 : in_row + 1;
    }
    bits &= slots[first_word() + word].x;
    visible += bitCount(bits);
    if (on) masks[mask_word(pixel, word)] = bits;
  } while (++word < kMaskWords);
  cut_off = cut_off || word < kMaskWords;
  out_of_range |= outside;
  return visible;
}

// Clears light samples that are not strictly above the carrier's plane: A·X + B·Y + C > 0. (bound horizon)
uint cut_at_horizon(uint pixel, vec3 above, float error) {
  uint visible = 0, word = 0;
  do {
    uint bits = masks[mask_word(pixel, word)], open = 0;
    for (uint i = 0; i < 8; ++i) {
      const uint place = 2 * (uint(first_row) * kFours + word * 8 + i);
      const vec4 s = (places[place] - first_cell.x) / half_cells.x, t = (places[place + 1] - first_cell.y) / half_cells.y;
      const vec4 value = above.x * s + above.y * t + above.z;
      for (uint j = 0; j < kPointsAtOnce; ++j) {
        if (value[j] <= error) bits &= ~(1u << (4 * i + j));
        open |= abs(value[j]) <= error ? 1u << (4 * i + j) : 0;
      }
    }
    histogram[lane_word(kOpenWord + word)] |= open;
    masks[mask_word(pixel, word)] = bits;
    visible += bitCount(bits);
  } while (++word < kMaskWords);
  cut_off = cut_off || word < kMaskWords;
  return visible;
}
