// SPDX-License-Identifier: Apache-2.0
#include "maps/backprojection/patches/backproject.shared.h"
#include "maps/backprojection/level_maps.shared.h"
#define GROUP_A_RECEIVER
#define LISTED_GROUPS
#define OWN_PUSH BackprojectPush
#include "maps/host/look_up.glsl"
#include "maps/host/group_kernel.glsl"
#define LIGHT_TABLE 5
#include "maps/backprojection/light_table.glsl"
#include "maps/backprojection/patches/fill.glsl"
#define PYRAMID_BINDING 6
#include "maps/backprojection/search.glsl"
#include "maps/backprojection/patches/sphere.glsl"

// Computes V = 1 - the sum of the parts of the light covered by the patches of the kernel's texels (Guennebaud, Barthe
// and Paulin 2006).

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };

// Specialisation constants: a pipeline has the code of its own options alone, because drivers for processors run both
// sides of a branch.
layout(constant_id = 0) const uint kFill = kFillEdges;  // kFillNone ...
layout(constant_id = 1) const uint kForm = kFormPatch;  // kFormPatch or kFormSphere
layout(constant_id = 2) const bool kSearch = true;      // true: a pyramid bounds the texels of a kernel
layout(constant_id = 3) const uint kLevels = kFinestLevel;  // kFinestLevel ...: levels of the map that are used

#define LEVEL_MAPS 7
#include "maps/backprojection/level_kernels.glsl"

Kernel kernel_at_level(MapFace face) {
  float near = nearest[asked.number];
  if (kForm == kFormSphere) return sphere_kernel(at_level(face), level_size(), near, false);
  return blocks_on_light(face, near, 0);
}

Kernel kernel_of(MapFace face) {
  float near = nearest[asked.number];
  begin_levels();
  // Narrowing by depths of single texels is not valid for blocks, whose depths are nearer.
  if (!kSearch || level() > 0) return kernel_within_budget(face, kernel_at_level(face));
  const Kernel kernel =
      kForm == kFormSphere ? sphere_kernel(face, lookup.size, near, true)
                           : search_kernel(face, light.lower, light.upper, near, 1.0, 0, true, kFill == kFillDiagonal ? 1 : 0);
  return kernel_within_budget(face, kernel);
}

// Patches extend to the depths of their left and lower neighbours; spheres extend beyond their texels.
bool nothing_hides(MapFace face, ivec2 first, ivec2 last) {
  vec2 depths;
  const ivec2 from = (first - 1) << level(), to = ((last + 1) << level()) - 1;
  return none_hides(face, from, to, own.layers, kForm == kFormPatch, depths);
}

float share_above() { return kForm == kFormSphere && own.ball != 0 ? sphere_above_horizon() : light_above_horizon(asked.e, asked.m); }

Tap texel_at(MapFace face, uint layer, uvec2 cell) { return ask_level(face, layer, cell); }

uint hidden_by_layer(MapFace face, uint layer, uvec2 cell) {
  const Tap tap = texel_at(face, layer, cell);
  if (!hides(tap)) return 0;
  if (kForm == kFormSphere) return sphere_hides(face, tap);
  Patch one = patch_of(face, asked.e, cell, uvec2(1), tap.depth);
  fill_gaps(one, face, layer, cell, kFill);
  return light_between(in_light_order(face, one.from), in_light_order(face, one.to));
}

// Returns a level's contribution to the hidden part: with two blended levels, its weight times the part hidden by a
// texel.
uint part_at_level(uint hidden) {
  if (kLevels != kLevelsByBudget || coarser_share == 0.0) return hidden;
  return uint(float(hidden) * (coarser ? coarser_share : 1.0 - coarser_share) + 0.5);
}

// Returns the area of the deepest layer of a texel that hides some of the light: adding all layers would count most
// bodies twice.
uint hidden_by(MapFace fine, uvec2 cell) {
  const MapFace face = at_level(fine);
  for (uint layer = own.layers; layer-- > 0;) {
    const uint hidden = hidden_by_layer(face, layer, cell);
    if (hidden > 0) return part_at_level(hidden);
  }
  return 0;
}

#include "maps/host/group_scalar_main.glsl"
