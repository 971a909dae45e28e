// SPDX-License-Identifier: Apache-2.0
// Shared by C++ and GLSL: faces fitted to the view of a camera (face_fit.hpp), in the form used by look-ups.
#ifndef PENUMBRA_MAPS_FITTED_FACE
#define PENUMBRA_MAPS_FITTED_FACE
#include "maps/host/map_view.shared.h"
#ifdef __cplusplus
#pragma once
namespace penumbra::maps::gpu {
#endif

// Face of e = (x, y, |z|) in the light's basis, seen from the light's centre: (a, b) = (row_a . e, row_b . e) / row_k .
// e, from 0 to 1 across the face.
struct FittedFace {
  vec3 row_a, row_b, row_k;
  vec3 inverse_a, inverse_b, inverse_1;  // inverse_a a + inverse_b b + inverse_1 has the direction of (a, b)
  vec3 along;                            // the face's axis: depths are distances along it
  uint axis;                             // the same: 0, 1, 2
  float ratio;                           // of LogarithmicPush; 0: linear rows
  float margin;                          // of LogarithmicPush
  float from, to;                        // range of depths along the view axis of the receivers that use this face
  uint side;                             // of the light's plane
};

// Head of the table of faces.
struct FaceTable {
  vec3 forward;  // a receiver's depth along the view axis is (dot(forward, p) + offset) / (dot(divisor, p) +
  float offset;  // divisor_offset)
  vec3 divisor;  // divisor = 0 and divisor_offset = 1, unless maps are made in a space other than the scene's
                 // (SceneSpace)
  float divisor_offset;
  uint count;
};

#ifdef __cplusplus
}  // namespace penumbra::maps::gpu
#endif
#endif  // PENUMBRA_MAPS_FITTED_FACE
