// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/backprojection/patches/bitmask.shared.h"
#include "maps/backprojection/level_maps.shared.h"
#define GROUP_A_RECEIVER
#define OWN_PUSH BitmaskPush
#include "maps/host/look_up.glsl"
#include "maps/host/group_kernel.glsl"
#define LIGHT_TABLE 5
#include "maps/backprojection/light_table.glsl"
#define SAMPLE_BANDS 6
#include "maps/backprojection/patches/sample_bands.glsl"
#include "maps/backprojection/patches/fill.glsl"
#define PYRAMID_BINDING 7
#include "maps/backprojection/search.glsl"

// Computes V from one bit for each light sample, so that overlapping occluders count once (Schwarz and Stamminger 2007,
// 2008). An occluder is a texel's rectangle, a quad between the centres of four texels that all hide light, a triangle
// between three of them if only three do, or, on a coarse level, the rectangle around a block's non-empty texels.

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };
layout(scalar, binding = 9) buffer Work { uint work[2]; };               // number of occluders processed, the lower
                                                                         // word first

// Specialisation constants: a pipeline has the code of its own options alone, because drivers for processors run both
// sides of a branch.
layout(constant_id = 0) const uint kOccluder = kOccluderQuad;  // kOccluderPatch ...
layout(constant_id = 1) const uint kFill = kFillNone;          // kFillNone ...
layout(constant_id = 2) const bool kSearch = true;             // true: a pyramid bounds the texels of a kernel
layout(constant_id = 3) const uint kLevels = kFinestLevel;     // kFinestLevel ...: levels of the map that are used

#define LEVEL_MAPS 8
#include "maps/backprojection/level_kernels.glsl"

// With two blended levels, returns whether the current level decides light sample j. The coarser level decides for a
// fraction `coarser_share` of the samples: those whose position in [0, 1) is below coarser_share. Positions are
// multiples of the golden ratio, so that any first n samples are evenly distributed.
bool is_mine(uint j) {
  if (kLevels != kLevelsByBudget || coarser_share == 0.0) return true;
  return (float(j * 2654435769u >> 8) / 16777216.0 < coarser_share) == coarser;
}

Tap texel_at(MapFace face, uint layer, uvec2 cell) { return ask_level(face, layer, cell); }

// Returns whether occluders lie between centres: quads and triangles extend to the texel's right and upper neighbours;
// patches extend to the left and lower neighbours.
bool between_centres() { return kOccluder == kOccluderQuad || kOccluder == kOccluderTriangle; }

// Returns whether texels first ... last of a face, none nearer to the light than depths.x or farther than depths.y, may
// hide samples: whether a rectangle of the light that bounds their projection, with a margin of one texel on every side
// as in all_beside_light, contains samples.
bool may_hide_samples(MapFace face, ivec2 first, ivec2 last, vec2 depths) {
  if (face.axis != 2) {
    vec2 lower, upper;
    seen_sideways(face, first, last, depths, lower, upper);
    return holds_samples(lower, upper);
  }
  const vec2 from = (face.lower + vec2(first - 1) * face.texel) * asked.e.z - asked.e.xy;
  const vec2 to = (face.lower + vec2(last + 2) * face.texel) * asked.e.z - asked.e.xy;
  const vec2 scales = depths / max(asked.e.z - depths, vec2(1e-8 * asked.e.z));
  return holds_samples(min(from * scales.x, from * scales.y), max(to * scales.x, to * scales.y));
}

bool nothing_hides(MapFace face, ivec2 first, ivec2 last) {
  const ivec2 from = (between_centres() ? first : first - 1) << level();
  const ivec2 to = ((between_centres() ? last + 2 : last + 1) << level()) - 1;
  vec2 depths;
  return none_hides(face, from, to, own.layers, true, depths) || !may_hide_samples(face, from, to, depths);
}

int padding() { return between_centres() ? 1 : 0; }

Kernel kernel_at_level(MapFace face) { return blocks_on_light(face, nearest[asked.number], padding()); }

Kernel kernel_of(MapFace face) {
  tile_shift = padding();
  begin_levels();
  // Narrowing by depths of single texels is not valid for blocks, whose depths are nearer.
  if (!kSearch || level() > 0) return kernel_within_budget(face, kernel_at_level(face));
  float near = nearest[asked.number];
  return kernel_within_budget(
      face, search_kernel(face, light.lower, light.upper, near, 1.0, padding(), true, kFill == kFillDiagonal ? 1 : 0));
}

void hide_patch(MapFace face, uint layer, uvec2 cell, Tap tap) {
  Patch one = patch_of(face, asked.e, cell, uvec2(1), tap.depth);
  fill_gaps(one, face, layer, cell, kFill);
  hide_rectangle(in_light_order(face, one.from), in_light_order(face, one.to));
}

// Hides the samples behind the box of a block's non-empty texels, at the block's nearest depth.
void hide_box(MapFace fine, uint layer, uvec2 cell, Tap tap) {
  const uint side = level_size();
  const uint box = levels[level_start + ((fine.map + layer * lookup.faces) * side + cell.y) * side + cell.x].y;
  const uvec2 first = uvec2(box & 255u, box >> 16 & 255u), last = uvec2(box >> 8 & 255u, box >> 24);
  const Patch one = patch_of(fine, asked.e, (cell << level()) + first, last - first + 1, tap.depth);
  hide_rectangle(in_light_order(fine, one.from), in_light_order(fine, one.to));
}

// Hides the samples behind the quad between the centres of this texel and of its right and upper neighbours: two
// triangles, along the same diagonal everywhere; or one, of the three texels that hide light.
void hide_quad(MapFace face, uint layer, uvec2 cell) {
  if (any(greaterThanEqual(cell + 1, uvec2(level_size())))) return;
  const uvec2 at[4] = uvec2[](cell, cell + uvec2(1, 0), cell + 1, cell + uvec2(0, 1));
  vec3 seen[4];
  uint hiding = 0;
  int missing = 0;
  const uint fewest = kOccluder == kOccluderTriangle ? 3 : 4;
  for (int k = 0; k < 4 && hiding + 4 >= uint(k) + fewest; ++k) {
    const Tap tap = texel_at(face, layer, at[k]);
    if (hides(tap)) {
      seen[k] = onto_light(asked.e, tap.depth * tap.direction);
      ++hiding;
    } else {
      missing = k;
    }
  }
  if (hiding == 4) {
    hide_triangle(seen[0], seen[1], seen[2]);
    hide_triangle(seen[0], seen[2], seen[3]);
  } else if (hiding == 3 && kOccluder == kOccluderTriangle) {
    hide_triangle(seen[(missing + 1) & 3], seen[(missing + 2) & 3], seen[(missing + 3) & 3]);
  }
}

void hide(MapFace fine, uvec2 cell) {
  const MapFace face = at_level(fine);
  for (uint layer = 0; layer < own.layers; ++layer) {
    if (between_centres()) {
      hide_quad(face, layer, cell);
      continue;
    }
    const Tap tap = texel_at(face, layer, cell);
    if (tap.depth >= tap.far) break;  // further layers are empty, too
    if (!hides(tap)) continue;
    if (kOccluder == kOccluderRect && level() > 0) {
      hide_box(fine, layer, cell, tap);
    } else {
      hide_patch(face, layer, cell, tap);
    }
  }
}

uint occluders_of_a_texel() { return own.layers; }
void add_work(uint occluders) {
  if (atomicAdd(work[0], occluders) + occluders < occluders) atomicAdd(work[1], 1);
}

#include "maps/host/group_mask_main.glsl"
