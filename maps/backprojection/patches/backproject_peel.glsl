// SPDX-License-Identifier: Apache-2.0
#include "maps/backprojection/patches/backproject_peel.shared.h"
#define GROUP_A_RECEIVER
#define LISTED_GROUPS
#define OWN_PUSH PeelLookPush
#include "maps/host/look_up.glsl"
#include "maps/host/group_kernel.glsl"
#define LIGHT_TABLE 5
#include "maps/backprojection/light_table.glsl"
#include "maps/backprojection/patches/fill.glsl"
#define PYRAMID_BINDING 6
#include "maps/backprojection/search.glsl"

// Computes V as backproject does, with several layers of the map (Bavoil, Callahan and Silva 2006). For each texel,
// only the deepest surface that hides some of the light counts. Where a kernel has more texels than permitted, every
// s-th of each row and column stands for a block of s x s.

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };

Kernel kernel_of(MapFace face) {
  float near = nearest[asked.number];
  const Kernel kernel = search_kernel(face, light.lower, light.upper, near, 1.0, 0, false, 0);
  // The square root of the ratio of a kernel's texels to the permitted ones: a block is as wide as the distance between
  // two sampled texels on each axis.
  const ivec2 extent = kernel.last - kernel.first + 1;
  const float side = floor(sqrt(float(own.samples)));
  stride = own.samples == 0 ? 1 : max(int(ceil(float(max(extent.x, extent.y)) / side)), 1);
  return kernel;
}

bool nothing_hides(MapFace face, ivec2 first, ivec2 last) {
  vec2 depths;
  return none_hides(face, first - 1, last, own.layers, true, depths);
}

float share_above() { return light_above_horizon(asked.e, asked.m); }

Tap texel_at(MapFace face, uint layer, uvec2 cell) { return ask_texel(face, layer, cell); }

uint hidden_by(MapFace face, uvec2 cell) {
  const uvec2 end = min(cell + uint(stride), uvec2(lookup.size));
  const uvec2 middle = min(cell + uint(stride) / 2, end - 1);
  for (int layer = int(own.layers) - 1; layer >= 0; --layer) {
    const Tap tap = texel_at(face, uint(layer), middle);
    if (!hides(tap)) continue;
    const Patch one = patch_of(face, asked.e, cell, end - cell, tap.depth);
    const uint hidden = light_between(in_light_order(face, one.from), in_light_order(face, one.to));
    if (hidden > 0 || own.deepest == 1) return hidden;
  }
  return 0;
}

Kernel next_kernel(MapFace face, uint turn) { return kNoKernel; }

#include "maps/host/group_scalar_main.glsl"
