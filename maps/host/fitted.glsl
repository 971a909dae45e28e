// SPDX-License-Identifier: Apache-2.0
// Taps into faces fitted to the view of a camera (face_fit.hpp), in place of a window or a hemicube: for look-ups that
// define FITTED_FACES. Faces are in a table; a receiver uses the faces of its own depth.
#include "maps/host/fitted_face.glsl"

layout(scalar, binding = 4) readonly buffer Faces {
  FaceTable table_of_faces;
  FittedFace fitted_faces[];
};

// Neighbouring faces meet: points on their common border are in both.
const float kFaceBorder = 1.0 / 65536.0;

float receiver_depth;  // depth along the view axis, set by scalar_main.glsl

// Finds the position of a direction e = (x, y, |z|) and returns the index of its face, or the number of faces if no
// face contains e.
uint find_face(vec3 e, uint side, out vec2 place) {
  for (uint i = 0; i < table_of_faces.count; ++i) {
    const FittedFace face = fitted_faces[i];
    if (face.side != side || receiver_depth < face.from || receiver_depth >= face.to) continue;
    if (!face_place(face, e, place)) continue;
    if (all(greaterThanEqual(place, vec2(-kFaceBorder))) && all(lessThanEqual(place, vec2(1.0 + kFaceBorder)))) return i;
  }
  return table_of_faces.count;
}

// Returns texel `cell` of face `number`, as a tap on the receiver's side of the light's plane, in direction e = (x, y,
// |z|). A texel's width is its width at this position. A direction of 0: the texel looks behind the light's plane.
Tap tap_in_face(LightView view, uint first_map, uint size, uint number, uvec2 cell, vec3 e) {
  const FittedFace face = fitted_faces[number];
  const vec2 centre = (vec2(cell) + 0.5) / float(size);
  Tap tap;
  tap.direction = face_direction(face, centre);
  tap.texel = face_texel(face, centre, size);
  const uint texel = ((first_map + number) * size + cell.y) * size + cell.x;
  tap.far = view.far;
  tap.along = dot(face.along, e);
  tap.axis = int(face.axis);
  tap.mirrored = 1.0;
  tap.number = texel;
  tap.depth = tap.second = view.far;
  if (tap.direction != vec3(0.0)) {
    tap.depth = view.far * maps[texel];
    if (lookup.depth_use != kDepthFirst) tap.second = view.far * maps[texel + lookup.faces * size * size];
  } else {
    tap.direction = e / tap.along;
  }
  return tap;
}

// Returns the tap in direction d, which must not lie in the light's plane.
Tap fetch(LightView view, uint first_map, uint size, vec3 d) {
  const uint side = d.z < 0.0 ? 1 : 0;
  const vec3 e = vec3(d.xy, abs(d.z));
  vec2 place;
  const uint number = find_face(e, side, place);
  const bool found = number < table_of_faces.count;
  const uvec2 cell = uvec2(clamp(floor((found ? place : vec2(0.0)) * float(size)), vec2(0.0), vec2(float(size - 1))));
  Tap tap = tap_in_face(view, first_map, size, found ? number : 0, cell, e);
  if (!found) {
    tap.depth = tap.second = view.far;
    tap.direction = e / tap.along;
  }
  tap.mirrored = d.z < 0.0 ? -1.0 : 1.0;
  tap.direction.z *= tap.mirrored;
  return tap;
}
