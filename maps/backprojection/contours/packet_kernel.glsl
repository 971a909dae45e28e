// SPDX-License-Identifier: Apache-2.0
// Kernels of a packet's pixels, in cells, and the grouping of pixels that search for contours together. Included by
// contour.comp.

bool no_cells(ivec4 cells) { return cells.z < cells.x || cells.w < cells.y; }

// Returns the cells touched by a kernel's texels: those between its texels, and one more at both ends of each axis.
ivec4 cells_of(Kernel kernel) {
  return all(lessThanEqual(kernel.first, kernel.last)) ? ivec4(kernel.first, kernel.last + 1) : ivec4(0, 0, -1, -1);
}

// Finds where the light's centre is seen, and whether this point is within a contour of the current level.
void find_own(uint pixel) {
  const vec3 e = pixel_e[pixel];
  pixel_inside[pixel] = 0;
  if (own_face(view.side[side_number].face_count, e) != face_number) return;
  const vec3 f = to_face(face, e);
  const vec2 g = (f.xy / f.z - face.lower) / face.texel - 0.5;
  const vec2 first = clamp(floor(g), vec2(-1.0), vec2(float(level_size()) - 1.0));
  pixel_own[pixel] = ivec2(first);
  pixel_at[pixel] = g - first;
  uint corners = 0;
  for (int k = 0; k < 4; ++k) {
    const ivec2 texel = ivec2(first) + ivec2(k & 1, k >> 1);
    if (on_map(texel) && shades(pixel, texel)) corners |= 1u << k;
  }
  bool inside = corners == 15;
  for (uint edges = kEdges[corners]; edges != 0; edges >>= 8) {
    const vec2 a = from_own(pixel, ivec2(first), edges & 3), b = from_own(pixel, ivec2(first), edges >> 2 & 3);
    inside = inside || cross2(a, b) >= 0.0;
  }
  pixel_inside[pixel] = inside ? 1 : 0;
}

// Returns the cells of the current level that can hold contours. A block of texels has the nearest depth of its texels,
// and an edge in a cell is between two of its four blocks: the nearest depth in a kernel is therefore the nearest of
// all blocks that the kernel touches and of their neighbours.
ivec4 cells_at_level(uint pixel) {
  if (level() == 0) return pixel_cells[pixel];
  const vec3 e = pixel_e[pixel];
  const int shift = int(level());
  Kernel kernel = kernel_on(map_face, lookup.size, e, light.lower, light.upper, nearest[side_number], 0);
  for (uint round = 0; round < 2 && kSearch && face.axis == 2 && !is_empty(kernel); ++round) {
    const ivec2 first = max((kernel.first >> shift) - 1, ivec2(0)) << shift;
    const ivec2 last = min(((kernel.last >> shift) + 2) << shift, ivec2(lookup.size)) - 1;
    const float near = view.far * depth_range_of_cells(face.map, uvec2(first), uvec2(last + 1)).x;
    kernel = kernel_on(map_face, lookup.size, e, light.lower, light.upper, near, 0);
  }
  return is_empty(kernel) ? ivec4(0, 0, -1, -1) : ivec4(kernel.first >> shift, (kernel.last >> shift) + 1);
}

// Returns the cells of the map that contain the cells of the level, for a pixel with contours there.
ivec4 find_kernel_at_level(uint pixel) {
  begin_level(own.level);
  ivec4 cells = cells_at_level(pixel);
  const int shift = int(level());
  const ivec4 fine = ivec4(cells.xy << shift, min(cells.zw << shift, ivec2(lookup.size)));
  if (kSearch && !no_cells(cells)) {
    const ivec2 first = max(cells.xy - 1, 0), last = min(cells.zw, ivec2(level_size()) - 1);
    const vec2 limits = thresholds(bounds_of(face, pixel_e[pixel], pixel_m[pixel]), face, first, last, view.far);
    const ivec2 end = min((last + 1) << shift, ivec2(lookup.size));
    const vec2 range = view.far * depth_range_of_cells(face.map, uvec2(first << shift), uvec2(end));
    if (range.x >= limits.y || range.y < limits.x) cells = ivec4(0, 0, -1, -1);
  }
  return no_cells(cells) ? cells : fine;
}

// Returns the kernel on the map after Guennebaud 2006: parts that the nearest depth in the kernel cannot hide are
// removed, repeatedly; if no texel, or every texel, in front of the receiver shades, there is no contour.
ivec4 find_kernel_on_map(uint pixel) {
  const vec3 e = pixel_e[pixel];
  ivec4 cells = cells_of(kernel_on(face, lookup.size, e, light.lower, light.upper, nearest[side_number], 0));
  const Bounds alone = bounds_of(face, e, pixel_m[pixel]);
  for (uint round = 0; round < 4 && kSearch && !no_cells(cells); ++round) {
    const vec2 range = view.far * depth_range_of_cells(face.map, uvec2(cells.xy), uvec2(cells.zw));
    const vec2 limits = thresholds(alone, face, max(cells.xy - 1, 0), min(cells.zw, ivec2(lookup.size) - 1), view.far);
    if (range.x >= limits.y || range.y < limits.x) cells = ivec4(0, 0, -1, -1);
    if (no_cells(cells) || face.axis != 2) break;
    const ivec4 narrow = cells_of(kernel_on(face, lookup.size, e, light.lower, light.upper, range.x, 0));
    if (no_cells(narrow)) {
      cells = narrow;
      break;
    }
    const ivec4 within = ivec4(max(narrow.xy, cells.xy), min(narrow.zw, cells.zw));
    if (within == cells) break;
    cells = within;
  }
  return cells;
}

void find_kernel(uint pixel) {
  const ivec4 cells = kLevels == kOneLevel ? find_kernel_at_level(pixel) : find_kernel_on_map(pixel);
  pixel_cells[pixel] = cells;
  // The extent in texels is one less than the extent in cells, on both axes.
  pixel_wanted[pixel] = kLevels == kFinestLevel || no_cells(cells) ? 0.0 : wanted_level(max((cells.zw - cells.xy) >> own.level, ivec2(1)));
  if (kLevels != kFinestLevel && !no_cells(cells)) return;  // `inside` is then decided on the levels in use
  find_own(pixel);
  if (pixel_inside[pixel] != 0 && lookup.first_row == 0) pixel_sum[pixel] += kContourWhole;
}

#ifndef SORTS_OUT
// Yang 2009, equations 4 to 6, for members with kernels that lie in `cells` together: the probability that their
// contours are the same, and the cost of a common search. A node costs 1; the relative costs of an edge and an area are
// not tuned (docs/packet.md).
layout(constant_id = 3) const float kEdgeCost = 1.0;
layout(constant_id = 4) const float kAreaCost = 1.0;

bool is_coherent(ivec4 cells) {
  const vec2 extent = vec2(cells.zw - cells.xy + 1);
  float apart = 0.0;
  float own_cost = 0.0;
  vec2 heights = vec2(1e30, 0.0);
  for (uint i = 0; i < member_count; ++i) {
    const ivec4 mine = pixel_cells[members[i]];
    const float width = sqrt(float(mine.z - mine.x + 1) * float(mine.w - mine.y + 1));
    own_cost += (log2(width) + kEdgeCost + kAreaCost) * width;
    const float z = pixel_e[members[i]].z;
    heights = vec2(min(heights.x, z), max(heights.y, z));
  }
  const float width = sqrt(extent.x * extent.y);
  const float cost = (log2(width) + kEdgeCost + kAreaCost * float(member_count)) * width;
  if (kSearch) {
    const vec2 range = view.far * depth_range_of_cells(face.map, uvec2(cells.xy), uvec2(cells.zw));
    const float shared_range = max(0.0, min(heights.y, range.y) - max(heights.x, range.x));
    const float null_share = range.y > range.x ? shared_range / (range.y - range.x) : 0.0;
    apart = 1.0 - pow(max(0.0, 1.0 - null_share), extent.x * extent.y);
  }
  return apart <= own.divergence && cost <= own_cost;
}

// Selects, of the pixels on this side, those with cells to search on this face.
void choose_members(uint pixels) {
  member_count = 0;
  ivec4 cells = ivec4(1 << 20, 1 << 20, -1, -1);
  for (uint i = 0; i < pixels; ++i) {
    if (pixel_state[i] != side_number || no_cells(pixel_cells[i])) continue;
    members[member_count++] = i;
    done.kernel_cells += uint(pixel_cells[i].z - pixel_cells[i].x + 1) * uint(pixel_cells[i].w - pixel_cells[i].y + 1);
    cells = ivec4(min(cells.xy, pixel_cells[i].xy), max(cells.zw, pixel_cells[i].zw));
  }
  together = 0;
  if (member_count < 2) return;
  if (kLevels == kLevelsByBudget) {  // pixels of other levels have other contours
    for (uint i = 1; i < member_count; ++i) {
      if (finer_level(pixel_wanted[members[i]]) == finer_level(pixel_wanted[members[0]])) continue;
      ++done.parted;
      return;
    }
  }
  if (view.side[side_number].face_count == 1 && is_coherent(cells)) together = 1;
  if (together == 0) ++done.parted;
}
#endif
