// SPDX-License-Identifier: Apache-2.0
// Integrals of a rectangle light's texture, constant in each texel. Twin of texture_weights.cpp, which fills `table`:
// rows of texels from the bottom, P(x) of each row = ∫ luminance from −1 to x, and PP = ∫ P; all for a light of weight
// 1.

/// Returns the weight of the part of the light below y.
double weight_below(double y, uvec2 texels) {
  const double at = (y + 1.0LF) * 0.5LF * double(texels.y);
  const uint row = uint(clamp(int(floor(at)), 0, int(texels.y) - 1));
  return mix(table[row], table[row + 1], clamp(at - double(row), 0.0LF, 1.0LF));
}

/// Returns P and PP of a row at x.
dvec2 row_sums(uint row, double x, uvec2 texels) {
  const double step = 2.0LF / double(texels.x), at = (x + 1.0LF) / step;
  const uint column = uint(clamp(int(floor(at)), 0, int(texels.x) - 1));
  const uint first = texels.y + 1 + 2 * (row * (texels.x + 1) + column);
  const double p = table[first], pp = table[first + 1], beyond = (at - double(column)) * step;
  const double rise = (table[first + 2] - p) / step * beyond;
  return dvec2(p + rise, pp + (p + 0.5LF * rise) * beyond);
}

/// Returns ∫ P dy along the segment, row by row.
double weight_left_of(dvec2 from, dvec2 to, uvec2 texels) {
  const dvec2 low = from.y < to.y ? from : to, high = from.y < to.y ? to : from;
  const double rows = 0.5LF * double(texels.y), rise = high.y - low.y;
  if (!(rise > 0.0LF)) return 0.0LF;
  const int last = clamp(int(floor((high.y + 1.0LF) * rows)), 0, int(texels.y) - 1);
  double sum = 0.0LF, x = low.x, y = low.y;
  for (int row = clamp(int(floor((low.y + 1.0LF) * rows)), 0, last); row <= last; ++row) {
    const double next_y = row == last ? high.y : min(double(row + 1) / rows - 1.0LF, high.y);
    const double next_x = row == last ? high.x : low.x + (high.x - low.x) * ((next_y - low.y) / rise);
    const double wide = next_x - x;
    // Mean of P over x: the difference of PP, unless that cancels.
    const double mean = abs(wide) > 0.00000095367431640625LF  // 2⁻²⁰
                            ? (row_sums(uint(row), next_x, texels).y - row_sums(uint(row), x, texels).y) / wide
                            : row_sums(uint(row), 0.5LF * (x + next_x), texels).x;
    sum += mean * (next_y - y);
    x = next_x;
    y = next_y;
  }
  return from.y < to.y ? sum : -sum;
}

/// Returns ∫ P dy along the rim, from its corner (1, −1) counter-clockwise to the point where the direction of the fan
/// leaves the square.
double weight_of_fan(double fan, uvec2 texels) { return fan < 0.5LF ? weight_below(2.0LF * fan, texels) : 1.0LF; }
