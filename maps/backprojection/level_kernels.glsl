// Kernels on the levels (levels.glsl) of a receiver that a workgroup looks at (group_kernel.glsl): the second, on the
// coarser of two levels, comes after the first. The shader defines
//   Kernel kernel_at_level(MapFace face)    the receiver's kernel on the level at hand
#include "maps/backprojection/levels.glsl"

float coarser_share = 0.0;  // what the coarser of two levels counts for
bool coarser = false;       // the coarser of two is looked at now

Kernel kernel_at_level(MapFace face);

// A texel of the level at hand, as ask_texel has one of the map.
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

// The kernel on the finer level of those that this kernel's extent on the level at hand asks for.
Kernel kernel_within_budget(MapFace face, Kernel kernel) {
  if (kLevels != kLevelsByBudget || is_empty(kernel)) return kernel;
  const float wanted = wanted_level(kernel.last - kernel.first + 1);
  coarser_share = coarser_part(wanted);
  look_at_level(finer_level(wanted));
  return level() == own.level ? kernel : kernel_at_level(face);
}

Kernel next_kernel(MapFace face, uint turn) {
  if (kLevels != kLevelsByBudget || turn > 1 || coarser_share == 0.0 || level() >= kCoarsestLevel) return kNoKernel;
  coarser = true;
  look_at_level(level() + 1);
  return kernel_at_level(face);
}
