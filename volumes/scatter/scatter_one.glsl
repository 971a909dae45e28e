// SPDX-License-Identifier: Apache-2.0
// Handles one projected edge for one view sample: its changes, and the samples that rounding leaves open because of it.
// Part of scatter_edges.comp and scatter_points.comp. Bounds: docs/edge-scatter.md.

// Returns p + d in the coordinates used for projection: x, y = (across, along) · d, and w, its height over p. It
// appears on the light at foot + height / w · (x, y).
vec3 seen_direction(vec3 d) {
  precise const float w = -dot(axis, d);
  precise const vec2 direction = vec2(dot(across, d), dot(along, d));
  return vec3(direction, w);
}

vec2 appears(vec3 direction) {
  precise const float q = at.height / direction.z;
  precise const vec2 seen = at.foot + q * direction.xy;
  return seen;
}

// Returns the error of a projected point's coordinates in cells. (bound X)
float error_of(float far, float w, float height, float from_foot, float away) {
  const float q = height / w;
  return kRound * (4.0 * per_length * far * q + from_foot * (4.0 * far / w + 4.0 * away / height + 8.0) +
                   per_length * 4.0 * away + 16.0 * skew * (half_cells.x + half_cells.y) * (1.0 + far / w)) +
         (per_length + from_foot / height) * push.deviation;
}

// Adds one projected edge to the changes of depths, with multiplicity k. `error_a`, `error_b`: errors of its ends'
// coordinates. Defined in scatter_rows.glsl or scatter_points.glsl.
void scatter(vec2 a, vec2 b, int k, float error_a, float error_b);

// Returns sgn(n · (p − anchor)); sets `open` if the product is within its rounding error.
int side_seen(vec3 p, vec3 n, vec3 anchor, inout bool open) {
  precise const vec3 d = p - anchor;
  precise const float f = dot(n, d);
  open = abs(f) <= 8.0 * kRound * dot(abs(n), abs(d)) && n != vec3(0.0);
  return f > 0.0 ? 1 : f < 0.0 ? -1 : 0;
}

// Scatters one edge with multiplicity k. Unless the edge stays well above p for the whole group (`settled`), its part
// outside of a window of about twice the light is clipped, so that ends near p's height, or behind p, do not affect
// precision in the window. If p is within rounding of one of the triangles' planes (`open`), that triangle is a sliver:
// the samples that it may hide are near its edges, which count as displaced by up to `sliver`. (bound window,
// bound sliver)
void scatter_seen(vec3 a, vec3 b, int k, bool open, bool settled, float sliver) {
  const vec3 da = a - at.p, db = b - at.p;
  const vec3 toward_a = seen_direction(da), toward_b = seen_direction(db);
  const float far_a = length(da), far_b = length(db), far = max(far_a, far_b);
  const vec2 window = 2.0 * half_cells + 2.0, xa = toward_a.xy * at.height + (at.foot - first_cell) * toward_a.z,
             xb = toward_b.xy * at.height + (at.foot - first_cell) * toward_b.z;
  const vec2 cut_off_by = vec2(cut_far(at.height - toward_a.z), cut_far(at.height - toward_b.z));
  const float lift = lift_per_length * (far + max(cut_off_by.x, cut_off_by.y));
  const vec2 wide_a = window * (toward_a.z + lift), wide_b = window * (toward_b.z + lift);
  const vec4 inside_a = vec4(wide_a - xa, wide_a + xa), inside_b = vec4(wide_b - xb, wide_b + xb);
  const vec4 t = inside_a / (inside_a - inside_b);
  const vec4 froms = mix(vec4(0.0), mix(t, vec4(2.0), lessThan(inside_b, vec4(0.0))), lessThan(inside_a, vec4(0.0)));
  const vec4 tos = mix(vec4(1.0), t, bvec4(ivec4(greaterThanEqual(inside_a, vec4(0.0))) * ivec4(lessThan(inside_b, vec4(0.0)))));
  const float from = settled ? 0.0 : max(max(froms.x, froms.y), max(froms.z, froms.w));
  const float to = settled ? 1.0 : min(min(tos.x, tos.y), min(tos.z, tos.w));
  const bool cut = from > 0.0 || to < 1.0;
  const vec3 start = from > 0.0 ? mix(toward_a, toward_b, from) : toward_a, end = to < 1.0 ? mix(toward_a, toward_b, to) : toward_b;
  const vec2 seen_a = appears(start), seen_b = appears(end);
  const float foot_a = length(seen_a - at.foot), foot_b = length(seen_b - at.foot), off = open ? sliver : 0.0;
  const float far_start = (cut ? far : far_a) + (from > 0.0 ? mix(cut_off_by.x, cut_off_by.y, from) : cut_off_by.x);
  const float far_end = (cut ? far : far_b) + (to < 1.0 ? mix(cut_off_by.x, cut_off_by.y, to) : cut_off_by.y);
  const float error_a = error_of(far_start, start.z, at.height, foot_a, away) + (at.height * per_length + foot_a) / start.z * off;
  const float error_b = error_of(far_end, end.z, at.height, foot_b, away) + (at.height * per_length + foot_b) / end.z * off;
  const bool matters = (k != 0 || open) && from <= to;
  const float least = 64.0 * kRound;
  const bool through_p = !settled && (start.z < least * max(far, far_start) || end.z < least * max(far, far_end));
  if (matters && through_p) open_pixel = true;            // the edge passes through p within rounding
  side_in_doubt = side_in_doubt || open;
  if (matters && !through_p) scatter(seen_a, seen_b, k, error_a, error_b);
}
