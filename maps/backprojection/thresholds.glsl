// SPDX-License-Identifier: Apache-2.0
// Bounds over a rectangle of texels and a group of receivers. Depth thresholds x and y: a depth nearer to the light
// than x shades all receivers of the group, a depth at y or farther shades none; and a test for texels that project
// outside the light. The bounds are those of blocks_light (taps.glsl) for a single texel, with a margin for rounding,
// so that a decision by bounds agrees with decisions for each texel (Yang et al. 2009, equation 3, here with each
// texel's own depth of the receiver's plane).

// Bounds of the receivers of a group, in a face's coordinates.
struct Bounds {
  vec3 m_low, m_high;            // normals away from the light, in the face's (a, b, w)
  float h_low, h_high;           // distances of the receivers' planes from the light's centre
  float z_low, z_high;           // heights of the receivers
  float across_low, across_high; // of the normals, across the face
  vec2 at_low, at_high;          // positions of the receivers on a face parallel to the light
  int above;                     // the centre is above the horizon of all: 1; of none: 0; of some: -1
};

// Rounding of a sum of three products is below 3 * 2^-24 of their magnitudes; here a few such sums follow each other,
// and divisions may be off by 2.5 units in the last place.
const float kSlack = 9.5367431640625e-7;  // 2^-20

Bounds bounds_of(MapFace face, vec3 e, vec3 m) {
  Bounds one;
  const vec3 f = to_face(face, m);
  const float slack = kSlack * dot(abs(m), abs(e)), h = dot(m, e);
  one.m_low = one.m_high = f;
  one.h_low = h - slack;
  one.h_high = h + slack;
  one.z_low = one.z_high = e.z;
  one.across_low = one.across_high = abs(f.x) + abs(f.y);
  one.at_low = one.at_high = e.xy / e.z;
  one.above = h > 0.0 ? 1 : 0;
  return one;
}

Bounds join(Bounds a, Bounds b) {
  a.m_low = min(a.m_low, b.m_low);
  a.m_high = max(a.m_high, b.m_high);
  a.h_low = min(a.h_low, b.h_low);
  a.h_high = max(a.h_high, b.h_high);
  a.z_low = min(a.z_low, b.z_low);
  a.z_high = max(a.z_high, b.z_high);
  a.at_low = min(a.at_low, b.at_low);
  a.at_high = max(a.at_high, b.at_high);
  a.across_low = min(a.across_low, b.across_low);
  a.across_high = max(a.across_high, b.across_high);
  if (a.above != b.above) a.above = -1;
  return a;
}

// Returns the range of m * x over the ranges of m and x.
vec2 product_range(vec2 m, vec2 x) {
  const vec4 all = vec4(m * x.x, m * x.y);
  return vec2(min(min(all.x, all.y), min(all.z, all.w)), max(max(all.x, all.y), max(all.z, all.w)));
}

// Returns the thresholds over texels lower ... upper of a face; never beyond `far`, the depth of empty texels, which
// shade no receiver.
vec2 thresholds(Bounds group, MapFace face, ivec2 lower, ivec2 upper, float far) {
  const bool planes = lookup.own_depth == 0;
  if (planes && group.above < 0) return vec2(-1e30, far);
  const vec2 from = face.lower + (vec2(lower) + 0.5) * face.texel, to = face.lower + (vec2(upper) + 0.5) * face.texel;
  vec2 limit = vec2(group.z_low, group.z_high);
  if (face.axis != 2) limit = vec2(group.z_low / to.y, group.z_high / max(from.y, 0.25 * face.texel.y));
  // Unless depth_use is kDepthFirst, shadow begins no nearer than the nearest surface, at a depth that depends on the
  // surface behind it, of which pyramids have no information.
  const bool nearest_alone = lookup.depth_use == kDepthFirst;
  const vec2 forgiven = (nearest_alone ? lookup.bias : 0.0) * max(face.texel.x, face.texel.y) * limit;
  vec2 plane = limit, slope = vec2(0.0);
  if (planes && group.above > 0) {
    const vec2 a = product_range(vec2(group.m_low.x, group.m_high.x), vec2(from.x, to.x));
    const vec2 b = product_range(vec2(group.m_low.y, group.m_high.y), vec2(from.y, to.y));
    const float slack = kSlack * (max(abs(a.x), abs(a.y)) + max(abs(b.x), abs(b.y)) +
                                  max(abs(group.m_low.z), abs(group.m_high.z)));
    const float facing_low = a.x + b.x + group.m_low.z - slack, facing_high = a.y + b.y + group.m_high.z + slack;
    if (facing_low > 0.0) plane.y = min(limit.y, group.h_high / facing_low);
    if (facing_high > 0.0) plane.x = min(limit.x, group.h_low / facing_high);
    slope.x = facing_high > 0.0 ? min(kSteepest, group.across_low / facing_high) : kSteepest;
    slope.y = facing_low > 0.0 ? min(kSteepest, group.across_high / facing_low) : kSteepest;
  }
  const vec2 taken = forgiven * (1.0 + slope);
  const float slack = 4.0 * kSlack * (plane.y + taken.y);
  // Where the centre is below the horizon, a depth near enough may be below the plane (above_plane).
  const bool all = nearest_alone && (!planes || group.above > 0);
  return min(vec2(all ? plane.x - taken.y - slack : -1e30, plane.y - taken.x + slack), far);
}

// Returns whether all receivers of the group see texels lower ... upper, at depths of at least `near`, outside the
// light's bounding rectangle. Same criterion as kernel_on (kernel.glsl), on a face parallel to the light; with a margin
// of one texel on every side, for texels that rounding moves to the light's border.
bool all_beside_light(Bounds group, MapFace face, ivec2 lower, ivec2 upper, float near, vec2 light_lower, vec2 light_upper) {
  if (face.axis != 2) return false;
  const float reach = max(1.0 / near - 1.0 / group.z_high, 0.0);
  const vec2 from = (group.at_low + reach * light_lower - face.lower) / face.texel;
  const vec2 to = (group.at_high + reach * light_upper - face.lower) / face.texel;
  return any(lessThan(vec2(upper + 2), from)) || any(greaterThan(vec2(lower - 1), to));
}

// Returns whether, from the receiver e, everything on a sideways face at `depths` between the centres of texels lower
// ... upper, with a margin of half a texel on every side, projects beyond one and the same side of the light's bounding
// rectangle. A point q projects to s / w (onto_light in kernel.glsl), w no less than kSlack of e's height. s - border *
// w is linear in each of q's three coordinates on the face: the minimum is at a corner, for either w. Twice eight
// roundings of 2^-24 are below the slack.
bool all_beside_light_sideways(vec3 e, MapFace face, ivec2 lower, ivec2 upper, vec2 depths, vec2 light_lower, vec2 light_upper) {
  const vec2 from = face.lower + vec2(lower) * face.texel, to = face.lower + vec2(upper + 1) * face.texel;
  const vec2 widest = max(-light_lower, light_upper);
  vec2 above = vec2(1e30), below = vec2(1e30);
  for (int k = 0; k < 8; ++k) {
    const vec3 corner = vec3((k & 1) == 0 ? from.x : to.x, (k & 2) == 0 ? from.y : to.y, 1.0);
    const vec3 q = from_face(face, corner) * ((k & 4) == 0 ? depths.x : depths.y), s = onto_light(e, q);
    const vec2 slack = 4.0 * kSlack * (abs(q.xy) * e.z + (abs(e.xy) + widest) * (e.z + abs(q.z)));
    const vec2 ends = vec2(s.z, kSlack * e.z);
    above = min(above, s.xy - slack - max(light_upper * ends.x, light_upper * ends.y));
    below = min(below, min(light_lower * ends.x, light_lower * ends.y) - slack - s.xy);
  }
  return any(greaterThan(max(above, below), vec2(0.0)));
}
