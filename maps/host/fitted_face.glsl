// SPDX-License-Identifier: Apache-2.0
// Directions in a fitted face.
#include "maps/host/fitted_face.shared.h"

// Returns the b of a row of a face (FittedFace::direction).
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
