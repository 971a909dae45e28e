// SPDX-License-Identifier: Apache-2.0
// Traversal of a kernel by a workgroup (group_kernel.glsl) in tiles: most of a kernel is lit, or projects outside the
// light, and such tiles are skipped as a whole. Before including this file, the main defines
//   void before_tiles()                       run by all invocations, between barriers, before tiles are tested
//   void look_at(MapFace face, uvec2 cell)

shared uint waiting_tiles[64];
shared uint waiting_count;

// Processes tiles of 8 x 8 texels, or of blocks, 64 tiles at a time: each invocation tests whether anything in one of
// the tiles can hide light, and all together process the tiles where something can. Rows beyond this part of the map
// belong to another dispatch.
void look_at_kernel(MapFace face, Kernel kernel) {
  const ivec2 first = ivec2(kernel.first.x, max(kernel.first.y, int(lookup.first_row)));
  const ivec2 last = ivec2(kernel.last.x, min(kernel.last.y, int(lookup.last_row)));
  if (any(lessThan(last, first))) return;
  const int wide = 8 * stride;
  // Blocks begin where the kernel begins; tiles of texels begin at nodes of a pyramid.
  const ivec2 begin = stride > 1 ? kernel.first : ((kernel.first + tile_shift) & ~7) - tile_shift;
  const int row = (first.y - begin.y) / wide;
  const uvec2 count = uvec2((last.x - begin.x) / wide + 1, (last.y - begin.y) / wide + 1 - row);
  const ivec2 origin = begin + ivec2(0, wide * row);
  for (uint done = 0; done < count.x * count.y; done += 64) {
    barrier();
    if (gl_LocalInvocationIndex == 0) waiting_count = 0;
    before_tiles();
    barrier();
    const uint end = min(done + 64, count.x * count.y);
    for (uint tile = done + gl_LocalInvocationIndex; tile < end; tile += gl_WorkGroupSize.x) {
      const ivec2 at = origin + wide * ivec2(tile % count.x, tile / count.x);
      if (!nothing_hides(face, at, at + wide - 1)) waiting_tiles[atomicAdd(waiting_count, 1)] = tile;
    }
    barrier();
    for (uint k = gl_LocalInvocationIndex; k < 64 * waiting_count; k += gl_WorkGroupSize.x) {
      const uint tile = waiting_tiles[k / 64];
      const ivec2 cell = origin + wide * ivec2(tile % count.x, tile / count.x) + stride * ivec2(k % 8, k / 8 % 8);
      if (all(greaterThanEqual(cell, first)) && all(lessThanEqual(cell, last))) look_at(face, uvec2(cell));
    }
  }
}
