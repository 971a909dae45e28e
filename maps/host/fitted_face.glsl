// SPDX-License-Identifier: Apache-2.0
// Directions and places in a fitted face.
#include "maps/host/fitted_face.shared.h"

// Returns the coordinate b (see FittedFace) of a place whose row is `row`; the inverse of face_row.
float face_b(FittedFace face, float row) {
  if (face.ratio == 0.0) return row;
  const float power = (row - face.margin) / (1.0 - 2.0 * face.margin);
  return (1.0 - exp(-power * log(face.ratio))) / (1.0 - 1.0 / face.ratio);
}

// Returns the direction of a position on a face, of length one along its axis; 0 if the direction leads behind the
// light's plane.
vec3 face_direction(FittedFace face, vec2 place) {
  if (face.ratio == kCircle) {
    const vec2 at = (place - 0.5) / (0.5 - face.margin);
    const float left = 1.0 - dot(at, at);
    return left > 0.0 ? vec3(2.0 * at / left, 1.0) : vec3(0.0);
  }
  const vec3 d = face.inverse_a * place.x + face.inverse_b * face_b(face, place.y) + face.inverse_1;
  const float along = dot(face.along, d);
  return along > 0.0 ? d / along : vec3(0.0);
}

// Returns the row, from 0 to 1, of the coordinate b (see FittedFace); 2 if b is beyond the end of a logarithmic face.
float face_row(FittedFace face, float b) {
  if (face.ratio == 0.0) return b;
  const float left = 1.0 - b * (1.0 - 1.0 / face.ratio);
  if (!(left > 0.0)) return 2.0;
  return face.margin - (1.0 - 2.0 * face.margin) * log(left) / log(face.ratio);
}

// Finds the place of a direction e = (x, y, |z|), which may be outside the face. Returns false for a direction behind
// the face, which has no place.
bool face_place(FittedFace face, vec3 e, out vec2 place) {
  place = vec2(2.0);
  if (face.ratio == kCircle) {
    place = 0.5 + (0.5 - face.margin) * e.xy / (length(e) + e.z);
    return true;
  }
  const float k = dot(face.row_k, e);
  if (!(k > 0.0)) return false;
  place = vec2(dot(face.row_a, e), dot(face.row_b, e)) / k;
  place.y = face_row(face, place.y);
  return true;
}

// Returns the width of a texel around a place, at depth 1.
float face_texel(FittedFace face, vec2 centre, uint size) {
  const vec2 half_texel = vec2(0.5 / float(size), 0.0);
  const vec3 across = face_direction(face, centre + half_texel) - face_direction(face, centre - half_texel);
  const vec3 down = face_direction(face, centre + half_texel.yx) - face_direction(face, centre - half_texel.yx);
  const vec3 widest = max(abs(across), abs(down));
  return max(widest.x, max(widest.y, widest.z));
}

// Returns the distance from the light's plane at depth 1 in the direction of a place; 0 behind the plane.
float face_height(FittedFace face, vec2 place) { return face.axis == 2 ? 1.0 : max(face_direction(face, place).z, 0.0); }
