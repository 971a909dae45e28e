// The share of the light that is above a receiver's horizon, sample by sample: for methods whose products say what hides
// the light in front of a place, and not which part of it. They take the smaller of the two shares. The shader has the
// samples bound: `vec3 samples[]`, x and y in the light's basis and their weight, and their number as own.sample_count.
float share_above(vec3 d, vec3 m) {
  float above = 0.0, all = 0.0;
  for (uint k = 0; k < own.sample_count; ++k) {
    const vec3 s = samples[k];
    all += s.z;
    if (dot(m, d - vec3(s.xy, 0.0)) > 0.0) above += s.z;
  }
  return above / all;
}
