// SPDX-License-Identifier: Apache-2.0
// Part of the light that lies beyond an edge in its plane as seen from the light's centre: the sector between the rays
// through the ends of the edge's part on the light, less the triangle (the coverage integral of Assarsson and
// Akenine-Moller 2003, as used by Guennebaud, Barthe and Paulin 2007). This part is empty if the edge misses the light.
// The signed sum along a closed outline is the part of the light left visible by the outline (contour.comp). Includers
// define LIGHT first, the binding of ContourLightProduct's buffer.
#include "maps/backprojection/contours/contour.shared.h"

layout(scalar, binding = LIGHT) readonly buffer Light {
  ContourLight light;
  vec3 light_corners[];  // corners of a polygon; for a textured rectangle, three numbers of its table each
                         // (radiance.glsl)
};

const float kPi = 3.14159265358979;

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Returns a point of the light's plane, given in the basis, in the coordinates in which the light is a unit shape.
vec2 to_unit(vec2 s) { return light.corners > 0 ? s : vec2(dot(light.to_unit_x, s), dot(light.to_unit_y, s)); }

// Returns the fraction of the light between a fixed ray from its centre and the ray through x, modulo 1.
float swept(vec2 x) {
  if (light.disk != 0) return atan(x.y, x.x) * (0.5 / kPi);
  if (light.corners == 0) {
    // Quarters around the axes; within one quarter the area grows as the tangent.
    const vec2 far = max(abs(x), vec2(1e-30));
    if (far.y <= far.x) return (x.x > 0.0 ? 0.0 : 0.5) + 0.125 * (x.y / (x.x > 0.0 ? far.x : -far.x));
    return (x.y > 0.0 ? 0.25 : 0.75) - 0.125 * (x.x / (x.y > 0.0 ? far.y : -far.y));
  }
  for (uint i = 0; i < light.corners; ++i) {
    const vec3 a = light_corners[i], b = light_corners[i + 1 < light.corners ? i + 1 : 0];
    if (cross2(a.xy, x) < 0.0 || cross2(b.xy, x) >= 0.0) continue;
    const vec2 side = b.xy - a.xy;
    return a.z + 0.5 * light.inverse_area * cross2(a.xy, x * (cross2(a.xy, side) / cross2(x, side)));
  }
  return 0.0;
}

// Returns the interval of t, 0 <= t <= 1, where a + t d is on the light; empty where y <= x.
vec2 clip_to_light(vec2 a, vec2 d) {
  vec2 t = vec2(0.0, 1.0);
  if (light.disk != 0) {
    const float dd = max(dot(d, d), 1e-30), ad = dot(a, d), root = ad * ad - dd * (dot(a, a) - 1.0);
    if (root <= 0.0) return vec2(0.0);
    return vec2(max(0.0, (-ad - sqrt(root)) / dd), min(1.0, (-ad + sqrt(root)) / dd));
  }
  if (light.corners == 0) {
    const vec2 inverse = 1.0 / vec2(abs(d.x) < 1e-30 ? 1e-30 : d.x, abs(d.y) < 1e-30 ? 1e-30 : d.y);
    const vec2 low = (-1.0 - a) * inverse, high = (1.0 - a) * inverse;
    const vec2 in_at = min(low, high), out_at = max(low, high);
    return vec2(max(0.0, max(in_at.x, in_at.y)), min(1.0, min(out_at.x, out_at.y)));
  }
  for (uint i = 0; i < light.corners; ++i) {
    const vec2 c = light_corners[i].xy, side = light_corners[i + 1 < light.corners ? i + 1 : 0].xy - c;
    const float inside = cross2(side, a - c), change = cross2(side, d);
    if (change > 0.0) {
      t.x = max(t.x, -inside / change);
    } else if (change < 0.0) {
      t.y = min(t.y, -inside / change);
    } else if (inside < 0.0) {
      return vec2(0.0);
    }
  }
  return t;
}

#include "maps/backprojection/contours/radiance.glsl"

// Returns the fraction of the light beyond the edge a b, in unit coordinates; with a texture, without terms that cancel
// along a closed outline (radiance.glsl). `turn`: 1 if the edge runs counter-clockwise around the centre, else -1. The
// caller decides `turn`: near the centre the results for 1 and -1 differ by the whole light, and `turn` must agree with
// the caller's count of contours around the centre.
float beyond_edge(vec2 a, vec2 b, float turn) {
  const vec2 d = b - a;
  const vec2 t = clip_to_light(a, d);
  if (!(t.x < t.y)) return 0.0;
  const vec2 from = a + t.x * d, to = t.y == 1.0 ? b : a + t.y * d;
  if (light.texture_width > 0) return radiance_beyond(from, to, turn);
  float sector = turn * (swept(to) - swept(from));
  // A sector is at most 5/9 of the light (of a triangle, by a line through its centroid): values far from [0, 5/9] come
  // from an edge that crosses the fixed ray of swept(), values just below 0 from rounding.
  sector = max(0.0, sector - floor(sector + 0.2));
  const float triangle =
      0.5 * abs(cross2(from, to)) * (light.disk != 0 ? 1.0 / kPi : light.corners == 0 ? 0.25 : light.inverse_area);
  return max(0.0, sector - triangle);
}

// Returns the fraction of the light above the horizon of the receiver e, m its normal away from the light: of
// points s with m . (e - s) > 0.
float light_above_horizon(vec3 e, vec3 m) {
  const float h = dot(m, e), mm = dot(m.xy, m.xy);
  const vec2 reach = max(-light.lower, light.upper);
  if (dot(abs(m.xy), reach) <= abs(h)) return h > 0.0 ? 1.0 : 0.0;
  const vec2 along = vec2(-m.y, m.x) * ((h < 0.0 ? -4.0 : 4.0) * (reach.x + reach.y) / sqrt(mm));
  const vec2 foot = m.xy * (h / mm);
  // Rounded sums of a texture may be beyond 0 ... 1.
  const float beyond = clamp(beyond_edge(to_unit(foot - along), to_unit(foot + along), 1.0), 0.0, 1.0);
  return h > 0.0 ? 1.0 - beyond : beyond;
}
