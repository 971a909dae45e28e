// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/nearest_caster.shared.h"
#include "maps/host/fitted_face.glsl"

// Computes the same as nearest_caster.comp, for faces fitted to the view of a camera.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 1) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 2) buffer Nearest { uint nearest[2]; };  // bits of floats >= 0, which have the order of
                                                                  // integers
layout(scalar, binding = 3) readonly buffer Faces {
  FaceTable table_of_faces;
  FittedFace fitted_faces[];
};
layout(scalar, push_constant) uniform Push { NearestPush push; };

shared uint smallest;

void main() {
  const uint row = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (row >= push.faces * push.size) return;  // whole workgroups
  const FittedFace face = fitted_faces[row / push.size];
  if (gl_LocalInvocationID.x == 0) smallest = 0x7f800000u;  // infinity
  barrier();
  for (uint x = gl_LocalInvocationID.x; x < push.size; x += gl_WorkGroupSize.x) {
    const float depth = maps[row * push.size + x];
    if (!(depth < 1.0)) continue;
    const vec2 place = (vec2(x, row % push.size) + 0.5) / float(push.size);
    const float height = face_height(face, place);
    if (height > 0.0) atomicMin(smallest, floatBitsToUint(depth * height * views[0].far));
  }
  barrier();
  if (gl_LocalInvocationID.x == 0) atomicMin(nearest[face.side], smallest);
}
