// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/nearest_caster.shared.h"

// Computes the smallest distance from the light's plane, on either side, of all surfaces in the maps of one light
// point. One workgroup for each row of a face.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 1) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 2) buffer Nearest { uint nearest[2]; };  // bits of floats >= 0, which have the order of
                                                                  // integers
layout(scalar, push_constant) uniform Push { NearestPush push; };

shared uint smallest;

void main() {
  const uint row = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (row >= push.faces * push.size) return;  // whole workgroups
  const uint map = row / push.size;
  const LightView view = views[0];
  const uint s = map >= view.side[0].first_face + view.side[0].face_count ? 1 : 0;
  // On a sideways face of a hemicube, the distance from the plane varies along its rows: b / w runs from 0 to 1.
  const bool sideways = map != view.side[s].first_face;
  const float height = sideways ? (float(row % push.size) + 0.5) / float(push.size) : 1.0;

  if (gl_LocalInvocationID.x == 0) smallest = 0x7f800000u;  // infinity
  barrier();
  for (uint x = gl_LocalInvocationID.x; x < push.size; x += gl_WorkGroupSize.x) {
    const float depth = maps[row * push.size + x];
    if (depth < 1.0) atomicMin(smallest, floatBitsToUint(depth * height * view.far));
  }
  barrier();
  if (gl_LocalInvocationID.x == 0) atomicMin(nearest[s], smallest);
}
