// Which texels hide light, and gap filling (Guennebaud, Barthe and Paulin 2006; the diagonal: Schwarz and Stamminger
// 2007). A patch reaches to its left and lower neighbours' patches where those hide light from the same receiver: what
// their common border shows at the neighbour's depth. A patch is only ever made larger. Included after
// group_kernel.glsl; the shader defines
//   Tap texel_at(MapFace face, uint layer, uvec2 cell)    a texel of a face, as the receiver asks it
#include "maps/backprojection/patch.glsl"

Tap texel_at(MapFace face, uint layer, uvec2 cell);

bool hides(Tap tap) {
  return in_front(asked.e, tap.direction, tap.depth) && blocks_light(tap, asked.e, asked.m, lookup.bias);
}

void fill_from(inout Patch one, MapFace face, uint layer, uvec2 cell, ivec2 step, bvec2 which) {
  const ivec2 at = ivec2(cell) + step;
  if (any(lessThan(at, ivec2(0)))) return;  // no gap is filled across the border of a face
  const Tap tap = texel_at(face, layer, uvec2(at));
  if (!hides(tap)) return;
  const vec2 corner = face.lower + vec2(cell) * face.texel;
  const vec2 middle = corner + 0.5 * face.texel;
  if (!in_front(asked.e, from_face(face, vec3(middle, 1.0)), tap.depth)) return;
  extend(one, border_on_light(face, asked.e, corner, middle, tap.depth), which);
}

void fill_gaps(inout Patch one, MapFace face, uint layer, uvec2 cell, bool diagonal) {
  fill_from(one, face, layer, cell, ivec2(-1, 0), bvec2(true, false));
  fill_from(one, face, layer, cell, ivec2(0, -1), bvec2(false, true));
  if (diagonal) fill_from(one, face, layer, cell, ivec2(-1, -1), bvec2(true, true));
}
