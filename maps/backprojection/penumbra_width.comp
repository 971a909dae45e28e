// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GROUP_A_RECEIVER
#include "maps/host/look_up.glsl"
#include "maps/host/group_kernel.glsl"
#define LIGHT_TABLE 5
#include "maps/backprojection/light_table.glsl"
#define PYRAMID_BINDING 6
#include "maps/backprojection/search.glsl"

// Computes a lower bound of the width of the narrowest penumbra at a receiver, parallel to the light: an occluder at
// depth z_o casts a penumbra of (z - z_o) / z_o times the light's width on a receiver at z, narrower the farther the
// occluder is from the light. Each of up to 8 x 8 nodes of the kernel gives the width for its largest possible z_o;
// infinity: nothing in the kernel hides light.

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };

const uint kInfinity = 0x7f800000u;
shared uint narrowest;  // bits of a float >= 0: such floats have the order of their bits

float width_of_node(MapFace face, Bounds receiver, ivec2 first, ivec2 last) {
  const vec2 depths = asked.view.far * depth_range(face.map, uvec2(first), uvec2(last));
  const vec2 shades = thresholds(receiver, face, first, last, asked.view.far);
  if (depths.x >= min(shades.y, asked.view.far)) return uintBitsToFloat(kInfinity);
  // If the deepest surface is the receiver's own, or if there is none, only the nearest surface is known to hide light.
  const float depth = depths.y < shades.x ? depths.y : depths.x;
  // On a sideways face, the height over the light's plane of a texel of row b is b times its depth.
  const float height = face.axis == 2 ? depth : depth * (float(first.y) + 0.5) * face.texel.y;
  const vec2 width = light.upper - light.lower;
  return min(width.x, width.y) * max(asked.e.z / height - 1.0, 0.0);
}

void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count) return;
  const Receiver receiver = receivers[lookup.first_receiver + i];
  if (gl_LocalInvocationIndex == 0) narrowest = kInfinity;
  barrier();
  if (receiver.n != vec3(0.0) && ask(receiver)) {
    for (uint number = 0; number < asked.side.face_count; ++number) {
      const MapFace face = face_of(asked.side, 0, lookup.size, number);
      float near = nearest[asked.number];
      const Kernel kernel = search_kernel(face, light.lower, light.upper, near, 1.0, 1, false, 0);
      if (is_empty(kernel)) continue;
      uint level = 0;
      while (any(greaterThan((kernel.last >> level) - (kernel.first >> level), ivec2(7)))) ++level;
      const uvec2 node = uvec2(kernel.first >> level) + uvec2(gl_LocalInvocationIndex % 8, gl_LocalInvocationIndex / 8);
      const ivec2 first = max(ivec2(node << level), kernel.first);
      const ivec2 last = min(ivec2(((node + 1) << level) - 1), kernel.last);
      if (any(lessThan(last, first))) continue;
      const Bounds bounds = bounds_of(face, asked.e, asked.m);
      atomicMin(narrowest, floatBitsToUint(width_of_node(face, bounds, first, last)));
    }
  }
  barrier();
  if (gl_LocalInvocationIndex == 0) results[lookup.first_result + i] = narrowest;
}
