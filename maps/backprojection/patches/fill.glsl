// SPDX-License-Identifier: Apache-2.0
// Selection of the texels that hide light, and gap filling (Guennebaud, Barthe and Paulin 2006; the diagonal: Schwarz
// and Stamminger 2007). A patch extends to its left and lower neighbours' patches where these hide light from the same
// receiver: to the projection of their common border at the neighbour's depth, if farther out (edges, diagonal), or in
// any case (shared; not from a paper). Included after group_kernel.glsl; the shader defines
//   Tap texel_at(MapFace face, uint layer, uvec2 cell)    a texel of a face, as looked up for the receiver
#include "maps/backprojection/patches/patch.glsl"

Tap texel_at(MapFace face, uint layer, uvec2 cell);

bool hides(Tap tap) {
  return in_front(asked.e, tap.direction, tap.depth) && blocks_light(tap, asked.e, asked.m, lookup.bias) &&
         above_plane(tap, asked.e, asked.m, lookup.bias);
}

void fill_from(inout Patch one, MapFace face, uint layer, uvec2 cell, ivec2 step, uint fill) {
  const ivec2 at = ivec2(cell) + step;
  if (any(lessThan(at, ivec2(0)))) return;  // no gap is filled across the border of a face
  const Tap tap = texel_at(face, layer, uvec2(at));
  if (!hides(tap)) return;
  const vec2 corner = face.lower + vec2(cell) * face.texel;
  const vec2 middle = corner + 0.5 * face.texel;
  if (!in_front(asked.e, from_face(face, vec3(middle, 1.0)), tap.depth)) return;
  const vec2 border = border_on_light(face, asked.e, corner, middle, tap.depth);
  if (fill == kFillShared) {
    share(one, border, lessThan(step, ivec2(0)));
  } else {
    extend(one, border, lessThan(step, ivec2(0)));
  }
}

void fill_gaps(inout Patch one, MapFace face, uint layer, uvec2 cell, uint fill) {
  if (fill == kFillNone) return;
  fill_from(one, face, layer, cell, ivec2(-1, 0), fill);
  fill_from(one, face, layer, cell, ivec2(0, -1), fill);
  if (fill == kFillDiagonal) fill_from(one, face, layer, cell, ivec2(-1, -1), fill);
}
