// SPDX-License-Identifier: Apache-2.0
// Fraction of the light covered by a rectangle in its plane, and fraction above the receiver's horizon. Includers
// define LIGHT_TABLE first, the binding of LightTable's buffer.
#include "maps/backprojection/light_table.shared.h"

layout(scalar, binding = LIGHT_TABLE) readonly buffer Table {
  LightTableHead light;
  float light_data[];  // corners of the outline, then the table's fractions
};

// Returns the fraction of the light left of and below `unit`, in [0, 1]^2 of its bounding rectangle, in units of 1 /
// kWholeLight. Rounded here, so that differences of neighbouring rectangles add up to exactly the difference of their
// union.
int light_up_to(vec2 unit) {
  precise float share = unit.x * unit.y;
  if (light.width * light.height > 1) {
    const vec2 at = unit * vec2(light.width, light.height);
    const vec2 cell = min(floor(at), vec2(light.width, light.height) - 1.0);
    const vec2 t = at - cell;
    const uint k = 2 * light.corners + uint(cell.y) * (light.width + 1) + uint(cell.x);
    precise const float below = mix(light_data[k], light_data[k + 1], t.x);
    precise const float above = mix(light_data[k + light.width + 1], light_data[k + light.width + 2], t.x);
    share = mix(below, above, t.y);
  }
  return int(share * float(kWholeLight) + 0.5);
}

// Returns the fraction of the light between two corners in its plane, in either order.
uint light_between(vec2 a, vec2 b) {
  const vec2 extent = light.upper - light.lower;
  precise const vec2 from = clamp((min(a, b) - light.lower) / extent, 0.0, 1.0);
  precise const vec2 to = clamp((max(a, b) - light.lower) / extent, 0.0, 1.0);
  if (from.x >= to.x || from.y >= to.y) return 0;
  const int share = light_up_to(to) - light_up_to(vec2(from.x, to.y)) - light_up_to(vec2(to.x, from.y)) + light_up_to(from);
  return uint(max(share, 0));
}

// Returns the fraction of a disk of radius 1 on the inner side of a line at the signed distance t from its centre: all
// of the disk for t >= 1, none for t <= -1. (Drivers may be 1e-4 off in asin.)
float disk_beside_line(float t) {
  if (abs(t) >= 1.0) return t > 0.0 ? 1.0 : 0.0;
  const float half_chord = sqrt((1.0 - t) * (1.0 + t));
  return (t * half_chord + atan(t, half_chord)) / 3.14159265358979 + 0.5;
}

// Returns the fraction of the light's area strictly above the horizon of the receiver e, m its normal away from the
// light: points s with m . (e - s) > 0.
float light_above_horizon(vec3 e, vec3 m) {
  const float h = dot(m, e);
  const vec2 most = vec2(m.x > 0.0 ? light.upper.x : light.lower.x, m.y > 0.0 ? light.upper.y : light.lower.y);
  const vec2 least = light.lower + light.upper - most;
  if (dot(m.xy, most) < h) return 1.0;
  if (dot(m.xy, least) >= h) return 0.0;
  if (light.radius > 0.0) return disk_beside_line(h / (length(m.xy) * light.radius));
  // Areas are summed around this point of the horizon's line: seen from there, the edge along the line spans no area.
  const vec2 o = m.xy * (h / dot(m.xy, m.xy));
  float twice = 0.0;
  for (uint i = 0; i < light.corners; ++i) {
    const uint j = i + 1 < light.corners ? i + 1 : 0;
    vec2 a = vec2(light_data[2 * i], light_data[2 * i + 1]), b = vec2(light_data[2 * j], light_data[2 * j + 1]);
    const float above_a = h - dot(m.xy, a), above_b = h - dot(m.xy, b);
    if (above_a <= 0.0 && above_b <= 0.0) continue;
    if (above_a < 0.0) a = mix(a, b, above_a / (above_a - above_b));
    if (above_b < 0.0) b = mix(b, a, above_b / (above_b - above_a));
    a -= o;
    b -= o;
    twice += a.x * b.y - a.y * b.x;
  }
  return clamp(0.5 * abs(twice) / light.area, 0.0, 1.0);
}
