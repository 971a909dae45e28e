// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/backprojection/patches/layer_rays.shared.h"
#include "maps/backprojection/patches/fill.shared.h"
#define GROUP_A_RECEIVER
#define OWN_PUSH LayerRaysPush
#include "maps/host/look_up.glsl"
#include "maps/host/group_kernel.glsl"
#define LIGHT_TABLE 5
#include "maps/backprojection/light_table.glsl"
#define SAMPLE_BANDS 6
#include "maps/backprojection/patches/light_samples.glsl"
#include "maps/backprojection/patches/fill.glsl"
#define PYRAMID_BINDING 7
#include "maps/backprojection/search.glsl"

// Casts rays from a receiver to each light sample through the layers of the centre's map (Lischinski and Rappoport
// 1998; Keating and Max 1999; Agrawala et al. 2000). Each texel's surface is a flat piece of the texel's extent at its
// depth; between neighbouring texels a wall joins two pieces that are no farther apart than `gap` texels; and with
// `solid` the space between an odd layer and the next is full. On a face, the positions (a, b) / w of a ray lie on a
// straight line along which 1 / w is linear. The ray is traversed texel by texel; it passes each texel between two
// depths.

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };
layout(scalar, binding = 8) buffer Work { uint work[2]; };  // number of texels passed, the lower word first

const float kLength = 16.0;  // number of texels in one query of the pyramid

float near_height;  // smallest height over the light's plane in the kernel

Tap texel_at(MapFace face, uint layer, uvec2 cell) { return ask_texel(face, layer, cell); }
bool is_mine(uint j) { return true; }
Kernel next_kernel(MapFace face, uint turn) { return kNoKernel; }
uint occluders_of_a_texel() { return 1; }
void add_work(uint texels) {
  if (atomicAdd(work[0], texels) + texels < texels) atomicAdd(work[1], 1);
}

Kernel kernel_of(MapFace face) {
  near_height = nearest[asked.number];
  const Kernel kernel = search_kernel(face, light.lower, light.upper, near_height, 1.0, 1, false, 0);
  if (is_empty(kernel)) return kernel;
  vec2 depths;
  return none_hides(face, kernel.first, kernel.last, own.layers, true, depths) ? kNoKernel : kernel;
}

#define LOOK_AT_KERNEL
#include "maps/host/group_mask_main.glsl"

// Writes a texel's surfaces, nearest first, to `depths` and returns their number.
uint surfaces_of(MapFace face, uvec2 cell, out float depths[kMostLayers]) {
  uint count = 0;
  for (; count < own.layers; ++count) {
    depths[count] = asked.view.far * maps[((face.map + count * lookup.faces) * lookup.size + cell.y) * lookup.size + cell.x];
    if (depths[count] >= asked.view.far) break;
  }
  return count;
}

bool layer_hides(MapFace face, uint layer, uvec2 cell) { return hides(texel_at(face, layer, cell)); }

// Depths of a texel's surfaces just in front of and just behind a depth; 0 and far where there is no surface.
struct Around {
  float before, behind;
  uint before_layer, behind_layer;
};
Around around(float depths[kMostLayers], uint count, float depth) {
  Around found = Around(0.0, asked.view.far, 0, 0);
  for (uint k = 0; k < count; ++k) {
    if (depths[k] <= depth) {
      found.before = depths[k];
      found.before_layer = k;
    } else {
      found.behind = depths[k];
      found.behind_layer = k;
      break;
    }
  }
  return found;
}

// Returns whether a wall between two neighbouring texels covers their border at the given depth. A wall joins the
// surface just in front of this depth in one texel (`before`) with the surface just behind it in the other (`behind`),
// unless either surface has a nearer continuation in the other texel (`goes_on_before`, `goes_on_behind`).
bool joined(float before, float behind, float goes_on_before, float goes_on_behind, float texel) {
  const float step = behind - before;
  return before > 0.0 && behind < asked.view.far && step <= own.gap * texel * before &&
         !(goes_on_before > 0.0 && abs(goes_on_before - before) < step) &&
         !(goes_on_behind < asked.view.far && abs(goes_on_behind - behind) < step);
}
bool wall_hides(MapFace face, uvec2 from, Around a, uvec2 to, Around b) {
  const float texel = max(face.texel.x, face.texel.y);
  if (joined(a.before, b.behind, b.before, a.behind, texel)) {
    if (layer_hides(face, a.before_layer, from) && layer_hides(face, b.behind_layer, to)) return true;
  }
  if (joined(b.before, a.behind, a.before, b.behind, texel)) {
    if (layer_hides(face, b.before_layer, to) && layer_hides(face, a.behind_layer, from)) return true;
  }
  return false;
}

// Returns whether a ray that passes a texel between the depths `from` and `to` meets a surface, or full space.
bool texel_stops(MapFace face, uvec2 cell, float depths[kMostLayers], uint count, float from, float to) {
  for (uint k = 0; k < count; ++k) {
    if (depths[k] >= from && depths[k] <= to && layer_hides(face, k, cell)) return true;
    if (own.solid == 0 || (k & 1) == 0) continue;
    if (depths[k - 1] <= to && depths[k] >= from && layer_hides(face, k - 1, cell) && layer_hides(face, k, cell)) return true;
  }
  return false;
}

// Clips `part`, the interval first ... last, to values with value + t * change >= 0.
void cut(inout vec2 part, float value, float change) {
  if (change == 0.0) {
    if (value < 0.0) part.y = -1.0;
    return;
  }
  const float t = -value / change;
  if (change > 0.0) {
    part.x = max(part.x, t);
  } else {
    part.y = min(part.y, t);
  }
}

// Returns whether the light sample at s is hidden by the contents of rows first_row ... last_row of the face, and the
// next row.
bool ray_is_stopped(MapFace face, vec2 s) {
  const vec3 start = to_face(face, asked.e), direction = to_face(face, vec3(s, 0.0)) - start;
  // The ray ends where the map is empty: there are no surfaces below `near_height`, and none that matter beyond the
  // receiver's height.
  vec2 part = vec2(0.0, 1.0 - 0.99999 * near_height / asked.e.z);
  const vec2 upper = face.lower + float(lookup.size) * face.texel;
  const vec2 rows = face.lower.y + vec2(lookup.first_row, min(lookup.last_row + 2, lookup.size)) * face.texel.y;
  cut(part, start.z, direction.z);
  cut(part, start.x - face.lower.x * start.z, direction.x - face.lower.x * direction.z);
  cut(part, upper.x * start.z - start.x, upper.x * direction.z - direction.x);
  cut(part, start.y - rows.x * start.z, direction.y - rows.x * direction.z);
  cut(part, rows.y * start.z - start.y, rows.y * direction.z - direction.y);
  if (!(part.x < part.y)) return false;
  const vec3 first = start + part.x * direction, last = start + part.y * direction;
  if (!(first.z > 0.0) || !(last.z > 0.0)) return false;
  const vec2 from = (first.xy / first.z - face.lower) / face.texel, to = (last.xy / last.z - face.lower) / face.texel;
  const vec2 over = to - from;
  const ivec2 most = ivec2(int(lookup.size) - 1), by = ivec2(over.x > 0.0 ? 1 : -1, over.y > 0.0 ? 1 : -1);
  const vec2 each = vec2(over.x != 0.0 ? abs(1.0 / over.x) : 1e30, over.y != 0.0 ? abs(1.0 / over.y) : 1e30);
  const vec2 inverse = vec2(1.0 / first.z, 1.0 / last.z);
  const uint lengths = uint(ceil(max(abs(over.x) + abs(over.y), 1.0) / kLength));

  // One loop for all lengths: if invocations leave two nested loops at different iterations, Mesa 22.3 on processors
  // loses some iterations. A length in which the pyramid shows that nothing hides light is skipped.
  float depths[kMostLayers], last_depths[kMostLayers];
  uint count = 0;
  ivec2 cell = ivec2(0);
  vec2 next = vec2(0.0);
  float entered = 0.0, ends = 0.0;  // depth of the ray at the entry into the texel; depth at the end of the length
  int left_to_go = -1;              // number of further texels in this length
  for (uint length = 0;;) {
    if (left_to_go < 0) {
      if (length == lengths) break;
      const float begins = float(length) / float(lengths);
      ends = float(++length) / float(lengths);
      const vec2 start_at = from + begins * over;
      cell = clamp(ivec2(floor(start_at)), ivec2(0), most);
      const ivec2 end = clamp(ivec2(floor(from + ends * over)), ivec2(0), most);
      vec2 range;
      if (none_hides(face, min(cell, end), max(cell, end), own.layers, false, range)) continue;
      left_to_go = abs(end.x - cell.x) + abs(end.y - cell.y);
      next = vec2(over.x != 0.0 ? (float(cell.x + max(by.x, 0)) - from.x) / over.x : 1e30,
                  over.y != 0.0 ? (float(cell.y + max(by.y, 0)) - from.y) / over.y : 1e30);
      entered = 1.0 / mix(inverse.x, inverse.y, begins);
      count = surfaces_of(face, uvec2(cell), depths);
    }
    ++looked_at;
    const bool across = next.x < next.y;
    const float at = left_to_go == 0 ? ends : clamp(across ? next.x : next.y, 0.0, ends);
    const float left = 1.0 / mix(inverse.x, inverse.y, at);
    if (texel_stops(face, uvec2(cell), depths, count, min(entered, left), max(entered, left))) return true;
    if (--left_to_go < 0) continue;
    const ivec2 before = cell;
    const uint last_count = count;
    last_depths = depths;
    if (across) {
      cell.x += by.x;
      next.x += each.x;
    } else {
      cell.y += by.y;
      next.y += each.y;
    }
    cell = clamp(cell, ivec2(0), most);  // against rounding
    count = surfaces_of(face, uvec2(cell), depths);
    if (own.gap > 0.0 && count > 0 && last_count > 0 &&
        wall_hides(face, uvec2(before), around(last_depths, last_count, left), uvec2(cell), around(depths, count, left))) {
      return true;
    }
    entered = left;
  }
  return false;
}

void look_at_kernel(MapFace face, Kernel kernel) {
  if (is_empty(kernel)) return;
  for (uint j = gl_LocalInvocationIndex; j < light_sample_count(); j += gl_WorkGroupSize.x) {
    const vec2 s = light_sample(j);
    if ((hidden_bits[j / 32] >> (j & 31) & 1u) != 0) continue;
    if (!(dot(asked.m, asked.e - vec3(s, 0.0)) > 0.0)) continue;  // below the horizon: not visible in any case
    if (ray_is_stopped(face, s)) hide_sample(j);
  }
  barrier();
}
