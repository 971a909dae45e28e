// SPDX-License-Identifier: Apache-2.0
// Returns the fraction of the light above the receiver's plane, from the first `samples` points of `pattern`, spread
// over the light; for look-ups without light points.
float share_above_horizon(vec3 d, vec3 m, uint samples) {
  uint above = 0;
  for (uint k = 0; k < samples; ++k) above += dot(m, d - vec3(pattern[k], 0.0)) > 0.0 ? 1 : 0;
  return float(above) / float(samples);
}
