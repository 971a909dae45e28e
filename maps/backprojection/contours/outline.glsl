// SPDX-License-Identifier: Apache-2.0
// Contours of the texels that shade a receiver, and the area of the light hidden by them. Included by contour.comp,
// after the state of its packet.
//
// Marching squares on the dual grid, between texels' centres, separate the texels of a map that shade a receiver from
// the others; a vertex lies midway, at the depth of the texel that shades. Seen from the receiver, the vertex projects
// to the light along the ray from the light's centre that leads away from the receiver's own direction. Hence the
// contours hide `inside` (1 if the receiver's own direction is inside, else 0) less the signed areas beyond the edges
// (radial.glsl):
//   hidden = inside - sum turn * beyond
// Texels beyond a face are empty, so contours close on every face: where a shape continues across two faces of a
// hemicube its parts share the border, up to the difference of two texels' depths there.
//
// `inside` and the `turn` of edges in the receiver's own cell come from the same predicate on the same numbers. The
// texels' results, or a second formula, could disagree with `turn`, and V would then be wrong by the whole light.

// Corners of a cell are numbered x + 2 y, its sides: bottom, right, top, left. For each set of shading corners, kEdges
// holds two edges from side to side, with the shading corners on their left: from | to << 2, plus 16 if the edge
// exists. Corners that shade across a diagonal are separate.
const uint kEdges[16] = uint[16](0x0000, 0x001c, 0x0011, 0x001d, 0x001b, 0x0018, 0x1b11, 0x0019, 0x0016, 0x161c, 0x0012,
                                 0x001e, 0x0017, 0x0014, 0x0013, 0x0000);
const vec2 kSide[4] = vec2[4](vec2(0.5, 0.0), vec2(1.0, 0.5), vec2(0.5, 1.0), vec2(0.0, 0.5));

bool on_map(ivec2 texel) { return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(level_size()))); }

// Returns the depth of a texel of the current level; far if the texel is empty.
float depth_of(ivec2 texel) {
  if (level() > 0) return level_tap(view, face, 0, uvec2(texel)).depth;
  return view.far * maps[(face.map * lookup.size + uint(texel.y)) * lookup.size + uint(texel.x)];
}

bool shades(uint pixel, ivec2 texel) {
  Tap tap = level() > 0 ? level_tap(view, face, 0, uvec2(texel)) : tap_of(view, lookup.size, face, uvec2(texel));
  tap.along = pixel_e[pixel].z / tap.direction.z;
  return tap.depth < view.far && blocks_light(tap, pixel_e[pixel], pixel_m[pixel], lookup.bias) &&
         above_plane(tap, pixel_e[pixel], pixel_m[pixel], lookup.bias);
}

// Returns the face that contains a receiver's own direction, for a side with `faces` faces.
uint own_face(uint faces, vec3 e) {
  const vec2 across = abs(e.xy);
  if (faces == 1 || max(across.x, across.y) <= e.z) return 0;
  return across.x >= across.y ? (e.x > 0.0 ? 1 : 2) : (e.y > 0.0 ? 3 : 4);
}

// Returns the offset of a vertex from the point where a face sees the light's centre, in texels.
vec2 from_own(uint pixel, ivec2 base, uint side) { return vec2(base - pixel_own[pixel]) + kSide[side] - pixel_at[pixel]; }

// Returns the projection of a vertex to the light, as seen from a receiver.
vec2 vertex_on_light(uint pixel, bool own_here, ivec2 base, uint side, float depth) {
  const vec3 e = pixel_e[pixel];
  if (face.axis == 2 && own_here) return from_own(pixel, base, side) * face.texel * (depth * e.z / (e.z - depth));
  const vec2 at = face.lower + (vec2(base) + kSide[side] + 0.5) * face.texel;
  const vec3 s = onto_light(e, depth * from_face(face, vec3(at, 1.0)));
  // On a sideways face, a texel's far end may be beyond the receiver's height: the vertex is then projected to the
  // largest distance.
  return s.xy / max(s.z, kSlack * e.z);
}

#ifndef SORTS_OUT
void add_edge(uint pixel, ivec2 base, uint edge, float depth_from, float depth_to) {
  const uint from = edge & 3, to = edge >> 2 & 3;
  const bool own_here = own_face(view.side[side_number].face_count, pixel_e[pixel]) == face_number;
  const vec2 a = vertex_on_light(pixel, own_here, base, from, depth_from);
  const vec2 b = vertex_on_light(pixel, own_here, base, to, depth_to);
  // An edge that projects outside the light hides none of it. This test is repeated here so that nodes may be skipped
  // for this reason (all_beside_light_sideways) without a change of rounding.
  if (face.axis != 2 && (any(greaterThan(min(a, b), light.upper)) || any(lessThan(max(a, b), light.lower)))) return;
  const float turned = own_here ? cross2(from_own(pixel, base, from), from_own(pixel, base, to)) : face_turn * cross2(a, b);
  const float turn = turned >= 0.0 ? 1.0 : -1.0;
  const float area = beyond_edge(to_unit(a), to_unit(b), turn * face_turn);
  atomicAdd(pixel_edges[pixel], int(turn) * int(floor(area * float(kContourWhole) + 0.5)));
}

// Adds the edges of a cell, for all members from `first` on.
void look_at_cell(ivec2 cell, uint first, uint members_asked) {
  ++done.cells;
  const ivec2 base = cell - 1;
  const vec2 limits = thresholds(group, face, max(base, ivec2(0)), min(cell, ivec2(level_size()) - 1), view.far);
  uint corners = 0;
  vec4 depths;
  bool differs = false;
  for (int k = 0; k < 4; ++k) {
    const ivec2 texel = base + ivec2(k & 1, k >> 1);
    depths[k] = view.far;
    if (!on_map(texel)) continue;
    depths[k] = depth_of(texel);
    if (depths[k] >= limits.y) continue;
    uint shaded = members_asked;
    if (depths[k] >= limits.x) {  // near some receiver's own depth
      shaded = 0;
      for (uint i = 0; i < members_asked; ++i) shaded += shades(members[first + i], texel) ? 1 : 0;
    }
    if (shaded == members_asked) corners |= 1u << k;
    differs = differs || (shaded > 0 && shaded < members_asked);
  }
  if (differs) {
    diverged = 1;
    return;
  }
  for (uint edges = kEdges[corners]; edges != 0; edges >>= 8) {
    ++done.edges;
    // For the side of the cell at each end of the edge: the depth of the side's shading corner.
    vec2 depth;
    for (int end = 0; end < 2; ++end) {
      const uint side = edges >> (2 * end) & 3;
      const uint one = side == 1 ? 1 : side == 2 ? 2 : 0, other = side == 0 ? 1 : side == 3 ? 2 : 3;
      depth[end] = (corners >> one & 1) != 0 ? depths[one] : depths[other];
    }
    for (uint i = 0; i < members_asked; ++i) add_edge(members[first + i], base, edges, depth.x, depth.y);
  }
}
#endif
