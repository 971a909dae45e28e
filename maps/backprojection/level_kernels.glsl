// SPDX-License-Identifier: Apache-2.0
// Kernels on the levels (levels.glsl) of a receiver processed by a workgroup (group_kernel.glsl). The kernel on the
// coarser of two levels is processed after the kernel on the finer level. The shader defines
//   Kernel kernel_at_level(MapFace face)    the receiver's kernel on the current level
#include "maps/backprojection/levels.glsl"

float coarser_share = 0.0;  // weight of the coarser of two levels
bool coarser = false;       // true while the coarser of two levels is processed

Kernel kernel_at_level(MapFace face);

// Returns a texel of the current level, as ask_texel returns one of the map.
Tap ask_level(MapFace face, uint layer, uvec2 cell) {
  if (level() == 0) return ask_texel(face, layer, cell);
  Tap tap = level_tap(asked.view, face, layer, cell);
  tap.along = asked.e.z / tap.direction.z;
  return tap;
}

void begin_levels() {
  look_at_level(own.level);
  coarser_share = 0.0;
  coarser = false;
}

// Returns the kernel on the finer of the levels selected by the extent of `kernel` on the current level.
Kernel kernel_within_budget(MapFace face, Kernel kernel) {
  if (kLevels != kLevelsByBudget || is_empty(kernel)) return kernel;
  const float wanted = wanted_level(kernel.last - kernel.first + 1);
  coarser_share = coarser_part(wanted);
  look_at_level(finer_level(wanted));
  return level() == own.level ? kernel : kernel_at_level(face);
}

// Returns the blocks of the current level that can hide some of the light, none of which is nearer to the light than
// `near`. Twice removes the parts of the kernel that its blocks and their neighbours (to whose depths patches and quads
// extend) cannot hide. Included after search.glsl and the definition of the light's `lower` and `upper`.
Kernel blocks_on_light(MapFace face, float near, int padding) {
  // On a sideways face, the lower border of a block may be many rows below its nearest texel.
  if (face.axis != 2 && level() > 0) return Kernel(ivec2(0), ivec2(level_size()) - 1, false);
  const int shift = int(level());
  Kernel kernel = kernel_on(at_level(face), level_size(), asked.e, light.lower, light.upper, near, padding);
  for (int round = 0; round < 2 && kSearch && shift > 0 && face.axis == 2 && !is_empty(kernel); ++round) {
    const ivec2 first = max(kernel.first - 1, ivec2(0)) << shift;
    const ivec2 last = min((kernel.last + 2) << shift, ivec2(lookup.size)) - 1;
    near = max(near, asked.view.far * depth_range(face.map, uvec2(first), uvec2(last)).x);
    kernel = kernel_on(at_level(face), level_size(), asked.e, light.lower, light.upper, near, padding);
  }
  return kernel;
}

Kernel next_kernel(MapFace face, uint turn) {
  if (kLevels != kLevelsByBudget || turn > 1 || coarser_share == 0.0 || level() >= kCoarsestLevel) return kNoKernel;
  coarser = true;
  look_at_level(level() + 1);
  return kernel_at_level(face);
}
