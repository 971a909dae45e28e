// SPDX-License-Identifier: Apache-2.0
// Radiance of a textured rectangle light beyond the edges of an outline, weighted by the texture's luminance, as a
// fraction of the whole light's. The region beyond an edge is a polygon: the edge, the outward ray through one of its
// ends, the light's border, and the ray back to the other end. By Green's theorem the polygon's radiance is the
// integral along its sides of the radiance left of them. Two edges that share an end contain the ray through this end
// in opposite directions, and these cancel; where an edge ends on the light's border, the ray has no length. So all
// rays are left out. Along an edge the integral is a sum over the texels that the edge passes, exact for a texture that
// is constant in each texel. Included by radial.glsl, after the light.

// Returns number k of the texture's table. The table holds, for each row of texels from t = -1 up, the fraction of the
// light's radiance that is in this row and left of each texel, and that of the whole row; then the fraction below each
// row, and below the upper end.
float radiance_table(uint k) { return light_corners[k / 3][k % 3]; }

// Returns the fraction of the radiance below the height y, -1 <= y <= 1.
float radiance_below(float y) {
  const float row = (0.5 * y + 0.5) * float(light.texture_height);
  const uint under = min(uint(max(row, 0.0)), light.texture_height - 1);
  const uint at = (light.texture_width + 1) * light.texture_height + under;
  return mix(radiance_table(at), radiance_table(at + 1), row - float(under));
}

// Returns the integral of the radiance left of the line from a to b, in unit coordinates: positive for a line upward.
float radiance_left_of(vec2 a, vec2 b) {
  const vec2 texels = vec2(light.texture_width, light.texture_height);
  const vec2 from = (0.5 * a + 0.5) * texels, d = (0.5 * b + 0.5) * texels - from;
  if (d.y == 0.0) return 0.0;
  const ivec2 last = ivec2(texels) - 1, change = ivec2(d.x < 0.0 ? -1 : 1, d.y < 0.0 ? -1 : 1);
  const vec2 inverse = 1.0 / vec2(d.x == 0.0 ? 1e-30 : d.x, d.y);
  ivec2 texel = clamp(ivec2(floor(from)), ivec2(0), last);
  float t = 0.0, sum = 0.0;
  // A line crosses at most as many borders between texels as the texture has columns and rows.
  for (uint k = 0; k < light.texture_width + light.texture_height; ++k) {
    const ivec2 next = texel + max(change, ivec2(0));  // the borders through which the line can leave the texel
    vec2 leaves = (vec2(next) - from) * inverse;
    // The light's own border ends no piece: the line ends there, or runs along it.
    if (next.x <= 0 || next.x > last.x || d.x == 0.0) leaves.x = 1.0;
    if (next.y <= 0 || next.y > last.y) leaves.y = 1.0;
    const float until = clamp(min(leaves.x, leaves.y), t, 1.0);
    const float across = clamp(from.x + 0.5 * (t + until) * d.x - float(texel.x), 0.0, 1.0);
    const uint at = uint(texel.y) * (light.texture_width + 1) + uint(texel.x);
    sum += (until - t) * mix(radiance_table(at), radiance_table(at + 1), across);
    if (until == 1.0) break;
    t = until;
    if (leaves.x <= leaves.y) {
      texel.x += change.x;
    } else {
      texel.y += change.y;
    }
  }
  return sum * d.y;
}

// Returns the point of the light's border in the direction of x from the centre.
vec2 onto_border(vec2 x) {
  const float far = max(abs(x.x), abs(x.y));
  if (far == 0.0) return vec2(1.0, 0.0);
  return abs(x.y) <= abs(x.x) ? vec2(x.x > 0.0 ? 1.0 : -1.0, x.y / far) : vec2(x.x / far, x.y > 0.0 ? 1.0 : -1.0);
}

// Returns the fraction of the light's radiance beyond the edge from `from` to `to`, both on the light, without the
// terms of the rays through its ends, which cancel along a closed outline. `turn` as for beyond_edge.
float radiance_beyond(vec2 from, vec2 to, float turn) {
  const vec2 first = turn > 0.0 ? from : to, second = turn > 0.0 ? to : from;
  const vec2 enters = onto_border(first), ends = onto_border(second);
  const float angle = cross2(enters, ends);
  float sum = radiance_left_of(second, first);
  // A sector of no width, or whose rays rounding has swapped, contains no border. Opposite rays halve the light.
  if (angle <= 0.0 && dot(enters, ends) > 0.0) return sum;
  // The light's right side is the only border that runs upward with radiance to its left. The sector's part of this
  // side begins where the sector's first ray meets it, or at the lower corner, and ends where the second ray meets it,
  // or at the upper corner.
  vec2 side = vec2(1.0, -1.0);
  for (int k = 0; k < 2; ++k) {
    const vec2 corner = vec2(1.0, k == 0 ? -1.0 : 1.0);
    const bool within = angle > 0.0 ? cross2(enters, corner) >= 0.0 && cross2(corner, ends) >= 0.0
                                    : !(cross2(ends, corner) > 0.0 && cross2(corner, enters) > 0.0);
    if (within) side = vec2(min(side.x, corner.y), max(side.y, corner.y));
  }
  if (enters.x == 1.0) side = vec2(enters.y, max(side.y, enters.y));
  if (ends.x == 1.0) side = vec2(min(side.x, ends.y), ends.y);
  if (side.x < side.y) sum += radiance_below(side.y) - radiance_below(side.x);
  return sum;
}
