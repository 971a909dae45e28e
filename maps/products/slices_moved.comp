// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/slices.shared.h"
#include "maps/products/shadow_depths.glsl"

// Moves the nearest surface of each texel to the slice where its shadow begins; surfaces behind are unchanged. One
// invocation for each texel.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Layers { float layers[]; };  // depths of the first layer, then of the
                                                                         // second
layout(scalar, binding = 1) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 2) readonly buffer Planes { SlicePlanes planes; };
layout(scalar, binding = 3) buffer Bits { uint bits[]; };
layout(scalar, push_constant) uniform Push { MovedPush push; };

// Returns the slice of a height, as slices.frag does; 0 beyond all slices.
uint slice_of(uint s, float height) {
  for (uint k = 0; k < planes.count; ++k) {
    if (height <= planes.limit[s][k]) return 1u << k;
  }
  return 0;
}

void main() {
  const uint texel = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x +
                     gl_LocalInvocationID.x;
  const uint layer = push.faces * push.size * push.size;
  if (texel >= layer || !(layers[texel] < 1.0)) return;
  const LightView view = views[0];
  const uint row = texel / push.size, face = row / push.size;
  const uint s = face >= view.side[0].first_face + view.side[0].face_count ? 1 : 0;
  const SideView side = view.side[s];
  const vec2 extent = side.face_count == 1 ? side.upper - side.lower : vec2(2.0);
  const float forgiven = min(push.bias * max(extent.x, extent.y) / float(push.size), 1.0);
  const bool sideways = face != side.first_face;
  const float height = view.far * (sideways ? (float(row % push.size) + 0.5) / float(push.size) : 1.0);

  const float nearest = layers[texel], second = layers[layer + texel];
  const float begins = shadow_begins(push.depth_use, nearest, second, forgiven);
  uint word = bits[texel];
  // Surfaces behind the second are in the second's slice or in later ones: if the second is in another slice, the
  // nearest is alone in its own.
  const uint own = slice_of(s, nearest * height);
  if (second >= 1.0 || slice_of(s, second * height) != own) word &= ~own;
  if (push.depth_use != kDepthSecond) word |= slice_of(s, begins * height);
  bits[texel] = word;
}
