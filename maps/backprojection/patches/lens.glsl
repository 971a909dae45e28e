// SPDX-License-Identifier: Apache-2.0
// Returns the area of a disk of radius r beyond a chord of length 2 half_chord at distance `away` from the centre.
// Small areas, too, are accurate to the precision of a float.
float segment(float r, float half_chord, float away) {
  const float turn = 2.0 * atan(half_chord, away);
  const float square = turn * turn;
  // turn - sin turn
  const float bulge = turn < 0.6 ? turn * square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)) : turn - sin(turn);
  return 0.5 * r * r * bulge;
}

// Returns the area of the intersection of two disks of a plane.
float lens(float r, float s, float apart) {
  const float small = min(r, s), large = max(r, s);
  const float gap = apart - large;  // signed distance of the small disk's centre from the large disk
  if (gap >= small) return 0.0;
  if (gap <= -small) return 3.14159265358979 * small * small;
  const float rise = (small - gap) * (small + gap) / (2.0 * apart);  // height of the large disk beyond the common chord
  const float half_chord = sqrt(max(0.0, rise * (2.0 * large - rise)));
  return segment(large, half_chord, large - rise) + segment(small, half_chord, gap + rise);
}
