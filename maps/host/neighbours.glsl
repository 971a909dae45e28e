// SPDX-License-Identifier: Apache-2.0
// Texels around the receiver's own, on its face and, in a hemicube, on the next face. Included after look_up.glsl.

// Returns the direction of a neighbour of the receiver's own texel, `offset` texels along the face's coordinates; of
// length one along the face's axis.
vec3 neighbour(Tap own, vec2 step, vec2 offset) {
  const vec2 by = step * offset;
  if (own.axis == 2) return own.direction + vec3(by, 0.0);
  if (own.axis == 0) return own.direction + vec3(0.0, by.x, by.y * own.mirrored);
  return own.direction + vec3(by.x, 0.0, by.y * own.mirrored);
}

bool texel_blocks(Tap tap, vec3 m, float h, float along, float texels_away) {
  if (lookup.own_depth != 0) return is_before_depth(tap, along, lookup.bias);
  return blocks(tap, m, h, along * (1.0 + kSteepest * tap.texel * max(texels_away, 1.0)), lookup.bias);
}
