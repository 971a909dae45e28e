// SPDX-License-Identifier: Apache-2.0
// Points of a light for looking up edges (Assarsson and Akenine-Möller 2003: a 4D table, here 32⁴). Twin of
// coverage_table.cpp. No point is at the centre, and a point is in the same quadrant as all places that are moved to
// it: so a cone's sector changes by less than half a light, and its orientation is known. Places on the rim stay on the
// rim.

const int kTableSide = 32;  // rectangle: 32 × 32 points; disk: 16 circles of 64

struct TablePoint {
  uint index;
  double fan;  // the area of the light from a fixed direction to the direction of this point
};

TablePoint square_point(dvec2 q) {
  const dvec2 place = round((q + 1.0LF) * (0.5LF * double(kTableSide - 1)));
  const ivec2 cell = clamp(ivec2(place), 0, kTableSide - 1);
  // Positions from the centre in half cells: integers, so that host and device classify the same points as steep.
  const ivec2 steps = 2 * cell - (kTableSide - 1);
  return TablePoint(uint(cell.y * kTableSide + cell.x), square_fan(double(steps.y), double(steps.x)));
}

TablePoint disk_point(dvec2 q) {
  const int circles = kTableSide / 2, spokes = 2 * kTableSide;
  const double turn = angle_of(q.y, q.x) / (4.0LF * kHalfPi);
  const int spoke = (int(floor((turn < 0.0LF ? turn + 1.0LF : turn) * double(spokes)))) % spokes;
  const int circle = clamp(int(floor(0.5LF * sqrt(dot(q, q)) * double(2 * circles - 1))), 0, circles - 1);
  return TablePoint(uint(circle * spokes + spoke), (double(spoke) + 0.5LF) / double(spokes) * 2.0LF * kHalfPi);
}
