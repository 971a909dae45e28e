// SPDX-License-Identifier: Apache-2.0
// Counts D at the corner of the light's frame. Included by count_edges.comp, after its data about the view sample.
// Bounds: docs/edge-scatter.md.

// Returns the number of triangles that the segment from p to c0 meets, one lane for each triangle (Woop et al. 2013: in
// coordinates with the ray as third axis, three two-dimensional products decide). (bound corner)
uint count_to_corner(uint head) {
  const vec2 lean = (first_cell - half_cells - at.foot) / at.height;  // the ray's direction for one unit of height
  uint met = 0, piece = head;
  for (; piece != kNone; piece = lists[piece]) {
    const uint count = lists[piece + 1];
    uint i = 0;
    for (; i < count; i += kLanes) {
      const bool used = i + gl_SubgroupInvocationID < count;
      const int texel = int(lists[piece + 2 + (used ? i + gl_SubgroupInvocationID : 0)]);
      const uvec4 t0 = texelFetch(corner_a, texel), t1 = texelFetch(corner_b, texel), t2 = texelFetch(corner_c, texel);
      const vec3 da = uintBitsToFloat(t0.xyz) - at.p, db = uintBitsToFloat(t1.xyz) - at.p, dc = uintBitsToFloat(t2.xyz) - at.p;
      const bool occludes = used && t0.w != kNone && t2.w != push.light && t1.w != at.plane;
      const vec3 w = -vec3(dot(axis, da), dot(axis, db), dot(axis, dc));
      const vec2 xa = vec2(dot(across, da), dot(along, da)) - lean * w.x;
      const vec2 xb = vec2(dot(across, db), dot(along, db)) - lean * w.y;
      const vec2 xc = vec2(dot(across, dc), dot(along, dc)) - lean * w.z;
      const vec3 f = vec3(xa.x * xb.y - xa.y * xb.x, xb.x * xc.y - xb.y * xc.x, xc.x * xa.y - xc.y * xa.x);
      const float far = max(length(da), max(length(db), length(dc))), away = length(from_center) / at.height;
      const float error_x = kRound * far * (5.0 * per_length * (1.0 + away) + (8.0 + 5.0 * away) * length(lean));
      const float size = max(max(size1(vec3(xa, 0.0)), size1(vec3(xb, 0.0))), size1(vec3(xc, 0.0)));
      const float error = (2.0 * error_x + 4.0 * kRound * size) * size + 2.0 * error_x * error_x;
      const bool one_sign = all(greaterThan(f, vec3(error))) || all(lessThan(f, vec3(-error)));
      const bool passes = any(greaterThan(f, vec3(error))) && any(lessThan(f, vec3(-error)));
      // Height over p of the point where the ray meets the triangle's plane: the mean of the corners' heights, with
      // weights f.
      const float total = f.x + f.y + f.z, meeting = (f.y * w.x + f.z * w.y + f.x * w.z) / total;
      const float slack = 16.0 * kRound * (far + push.reach), error_w = slack + 6.0 * error * far / max(abs(total), 1e-30);
      const float lowest = min(w.x, min(w.y, w.z)), highest = max(w.x, max(w.y, w.z));
      const bool within = (meeting > error_w && meeting < at.height - error_w) || (lowest > 16.0 * kRound * far && highest < at.height - slack);
      const bool without = passes || highest < -16.0 * kRound * far || lowest > at.height + slack ||
                           (one_sign && (meeting < -error_w || meeting > at.height + error_w));
      const bool hit = occludes && !without && one_sign && within;
      on_triangle = on_triangle || (occludes && is_on_triangle(da, db, dc));
      open_pixel = open_pixel || (occludes && !without && !hit);
      met += subgroupBallotBitCount(subgroupBallot(hit));
    }
    cut_off = cut_off || i < count;
  }
  cut_off = cut_off || piece != kNone;
  return met;
}
