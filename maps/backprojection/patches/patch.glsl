// SPDX-License-Identifier: Apache-2.0
// Micropatches (Guennebaud, Barthe and Paulin 2006): each texel of a map is a rectangle of its own extent at its own
// depth, parallel to the face; seen from the receiver, the rectangle covers a rectangle of the light. Included after
// kernel.glsl.
//
// On a face parallel to the light, borders at tangent alpha and depth z_s are seen at (alpha - a) f, f = z_s z / (z -
// z_s). On sideways faces of a hemicube, rows of a texel have different heights over the light's plane, and a texel's
// sides appear slanted; here the sides of a row are taken at its middle, so that neighbours still share borders.

// Returns the position on the light of a border across the first coordinate, at `at.x`, and of one across the second,
// at `at.y`, in the texel around `middle` with depth `depth`, in the order of face coordinates.
vec2 border_on_light(MapFace face, vec3 e, vec2 at, vec2 middle, float depth) {
  if (face.axis == 2) return (at * e.z - e.xy) * (depth / (e.z - depth));
  // The far side of a row may be beyond the receiver's height.
  const float row = min(at.y, middle.y + 0.999 * (e.z / depth - middle.y));
  const vec3 across = onto_light(e, depth * from_face(face, vec3(at.x, middle.y, 1.0)));
  const vec3 along = onto_light(e, depth * from_face(face, vec3(middle.x, row, 1.0)));
  const int a = face.axis == 0 ? 1 : 0;
  return vec2(across[a] / across.z, along[1 - a] / along.z);
}

// Rectangle of the light between the first and the last border of a texel, in the order of face coordinates.
struct Patch {
  vec2 from, to;
};

vec2 in_light_order(MapFace face, vec2 across) { return face.axis == 0 ? across.yx : across; }

// Returns the patch of the texels cell ... cell + count - 1, all at the given depth.
Patch patch_of(MapFace face, vec3 e, uvec2 cell, uvec2 count, float depth) {
  const vec2 from = face.lower + vec2(cell) * face.texel, to = face.lower + vec2(cell + count) * face.texel;
  const vec2 middle = 0.5 * (from + to);
  return Patch(border_on_light(face, e, from, middle, depth), border_on_light(face, e, to, middle, depth));
}

// Returns whether a point at this depth in a texel's direction is between the light's plane and the receiver. A texel
// for which rounding makes this false hides nothing.
bool in_front(vec3 e, vec3 direction, float depth) { return depth * direction.z < e.z; }

// Gap filling: extends the patch to the projection of the common border at the neighbour's depth, if farther out.
void extend(inout Patch one, vec2 neighbour, bvec2 which) {
  for (int k = 0; k < 2; ++k) {
    if (which[k]) one.from[k] = one.from[k] <= one.to[k] ? min(one.from[k], neighbour[k]) : max(one.from[k], neighbour[k]);
  }
}

// Moves the patch's border to the neighbour's projection, farther out or not: then neighbours neither leave a gap nor
// overlap. A neighbour whose projection is beyond the patch's other side leaves an empty patch.
void share(inout Patch one, vec2 neighbour, bvec2 which) {
  for (int k = 0; k < 2; ++k) {
    if (which[k]) one.from[k] = one.from[k] <= one.to[k] ? min(neighbour[k], one.to[k]) : max(neighbour[k], one.to[k]);
  }
}
