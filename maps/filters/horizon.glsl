// For look-ups that know no light points: the share of the light's `pattern`, so many points spread over it, that is
// above the receiver's plane.
float share_above_horizon(vec3 d, vec3 m, uint samples) {
  uint above = 0;
  for (uint k = 0; k < samples; ++k) above += dot(m, d - vec3(pattern[k], 0.0)) > 0.0 ? 1 : 0;
  return float(above) / float(samples);
}
