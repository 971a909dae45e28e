// SPDX-License-Identifier: Apache-2.0
// The depth at the light's corner, to which changes are added. Part of scatter_edges.comp and scatter_points.comp.
// Bounds: docs/edge-scatter.md.

// Opens the pixel if p is within rounding of a triangle whose side is not certain: half of all directions from p depend
// on that side, not only those close to its edges. Such a triangle is in the list of those that the segment to the
// corner may meet. (bound on)
void open_where_on(uint head, bool on) {
  uint piece = head;
  for (; piece != kNone; piece = lists[piece]) {
    const uint count = lists[piece + 1];
    uint i = 0;
    for (; i < count; ++i) {
      const int texel = int(lists[piece + 2 + i]);
      const uvec4 t0 = texelFetch(corner_a, texel), t1 = texelFetch(corner_b, texel), t2 = texelFetch(corner_c, texel);
      const bool occludes = t0.w != kNone && t2.w != push.light && t1.w != at.plane;
      const bool is_met = is_on_triangle(uintBitsToFloat(t0.xyz) - at.p, uintBitsToFloat(t1.xyz) - at.p, uintBitsToFloat(t2.xyz) - at.p);
      if (on && side_in_doubt && occludes && is_met) open_pixel = true;
    }
    cut_off = cut_off || i < count;
  }
  cut_off = cut_off || piece != kNone;
}

// Returns the number of triangles that the segment from p to the light's lower left corner meets (Woop et al. 2013: in
// coordinates with the ray as third axis, three two-dimensional products decide). With `one_will_do`, for view samples
// whose edges do not change the count, stops at one.
uint count_to_corner(uint head, bool on, bool one_will_do) {
  const vec4 none = vec4(-1e18);
  const Shaft shaft = make_shaft(-half_cells, -half_cells, subgroupMax(on ? slopes_of(-half_cells, -half_cells, at.foot, at.height) : none),
                                 subgroupMax(on ? at.height : 0.0));
  const vec2 lean = (first_cell - half_cells - at.foot) / at.height;  // the ray's direction in cells for one unit of
                                                                      // height
  uint met = 0;
  uint piece = head;
  for (; piece != kNone; piece = lists[piece]) {
    const uint count = lists[piece + 1];
    uint i = 0;
    for (; i < count && !(one_will_do && subgroupAll(!on || met > 0)); i += kLanes) {
      const bool used = i + gl_SubgroupInvocationID < count;
      const int texel = int(lists[piece + 2 + (used ? i + gl_SubgroupInvocationID : 0)]);
      const uvec4 t0 = texelFetch(corner_a, texel), t1 = texelFetch(corner_b, texel), t2 = texelFetch(corner_c, texel);
      const vec3 a = uintBitsToFloat(t0.xyz), b = uintBitsToFloat(t1.xyz), c = uintBitsToFloat(t2.xyz);
      const vec3 levels = vec3(dot(axis, a), dot(axis, b), dot(axis, c));
      const vec4 least = min(shaft.nx * a.x + shaft.ny * a.y + shaft.nz * a.z,
                             min(shaft.nx * b.x + shaft.ny * b.y + shaft.nz * b.z, shaft.nx * c.x + shaft.ny * c.y + shaft.nz * c.z));
      const bool hit = used && t0.w != kNone && t2.w != push.light && min(levels.x, min(levels.y, levels.z)) <= shaft.highest &&
                       max(levels.x, max(levels.y, levels.z)) >= shaft.lowest && all(lessThanEqual(least, shaft.beyond));
      const uvec4 hits = subgroupBallot(hit);
      for (uint word = 0; word < (kLanes + 31) / 32; ++word) {
        for (uint left = hits[word]; left != 0; left &= left - 1) {
          const uint from = word * 32 + uint(findLSB(left));
          const vec3 da = subgroupShuffle(a, from) - at.p, db = subgroupShuffle(b, from) - at.p, dc = subgroupShuffle(c, from) - at.p;
          const uint plane = subgroupShuffle(t1.w, from);
          const vec3 w = -vec3(dot(axis, da), dot(axis, db), dot(axis, dc));
          const vec2 xa = vec2(dot(across, da), dot(along, da)) - lean * w.x;
          const vec2 xb = vec2(dot(across, db), dot(along, db)) - lean * w.y;
          const vec2 xc = vec2(dot(across, dc), dot(along, dc)) - lean * w.z;
          const vec3 f = vec3(xa.x * xb.y - xa.y * xb.x, xb.x * xc.y - xb.y * xc.x, xc.x * xa.y - xc.y * xa.x);
          // Error bound: (bound corner).
          const float far = max(length(da), max(length(db), length(dc)));
          const float lengths = away / at.height;
          const float error_x = kRound * far * (5.0 * per_length * (1.0 + lengths) + (8.0 + 5.0 * lengths) * length(lean));
          const float size = max(max(size1(vec3(xa, 0.0)), size1(vec3(xb, 0.0))), size1(vec3(xc, 0.0)));
          const float error = (2.0 * error_x + 4.0 * kRound * size) * size + 2.0 * error_x * error_x;
          const bool all_above = all(greaterThan(f, vec3(error))), all_below = all(lessThan(f, vec3(-error)));
          const bool passes = any(greaterThan(f, vec3(error))) && any(lessThan(f, vec3(-error)));
          // Height over p of the point where the ray meets the triangle's plane: the mean of the corners' heights, with
          // weights f.
          const float total = f.x + f.y + f.z, at_meeting = (f.y * w.x + f.z * w.y + f.x * w.z) / total;
          const float error_w = 16.0 * kRound * (far + push.reach) + 6.0 * error * far / max(abs(total), 1e-30);
          const bool before_all = max(w.x, max(w.y, w.z)) < -16.0 * kRound * far;
          const bool beyond_all = min(w.x, min(w.y, w.z)) > at.height + 16.0 * kRound * (far + push.reach);
          const bool sure_within = (at_meeting > error_w && at_meeting < at.height - error_w) ||
                                   (min(w.x, min(w.y, w.z)) > 16.0 * kRound * far && max(w.x, max(w.y, w.z)) < at.height - 16.0 * kRound * (far + push.reach));
          const bool sure_without = passes || before_all || beyond_all || ((all_above || all_below) && (at_meeting < -error_w || at_meeting > at.height + error_w));
          if (on && plane != at.plane && !sure_without) {
            if ((all_above || all_below) && sure_within) {
              ++met;
            } else {
              open_pixel = true;
            }
          }
        }
      }
    }
    if (one_will_do && subgroupAll(!on || met > 0)) return met;
    cut_off = cut_off || i < count;
  }
  cut_off = cut_off || piece != kNone;
  return met;
}
