// SPDX-License-Identifier: Apache-2.0
// Returns the fraction of the light above a receiver's horizon, from the light samples: for methods whose products give
// the hidden fraction of the light at a position, but not which part is hidden. These methods use the smaller of the
// two fractions. The shader has the samples bound: `vec3 samples[]`, x and y in the light's basis and their weight, and
// their number as own.sample_count.
float share_above(vec3 d, vec3 m) {
  float above = 0.0, all = 0.0;
  for (uint k = 0; k < own.sample_count; ++k) {
    const vec3 s = samples[k];
    all += s.z;
    if (dot(m, d - vec3(s.xy, 0.0)) > 0.0) above += s.z;
  }
  return above / all;
}
