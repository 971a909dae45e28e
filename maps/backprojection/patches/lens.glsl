// A part of a disk of radius r behind a chord 2 half_chord long, that far from the centre. Small ones, too, to a float.
float segment(float r, float half_chord, float away) {
  const float turn = 2.0 * atan(half_chord, away);
  const float square = turn * turn;
  // turn - sin turn
  const float bulge = turn < 0.6 ? turn * square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)) : turn - sin(turn);
  return 0.5 * r * r * bulge;
}

// The area that two disks of a plane share.
float lens(float r, float s, float apart) {
  const float small = min(r, s), large = max(r, s);
  const float gap = apart - large;  // of the small one's centre
  if (gap >= small) return 0.0;
  if (gap <= -small) return 3.14159265358979 * small * small;
  const float rise = (small - gap) * (small + gap) / (2.0 * apart);  // of the large one, beyond their common chord
  const float half_chord = sqrt(max(0.0, rise * (2.0 * large - rise)));
  return segment(large, half_chord, large - rise) + segment(small, half_chord, gap + rise);
}
