// SPDX-License-Identifier: Apache-2.0
// Search for the edges of a kernel: cell by cell, or below nodes of a pyramid. Included by contour.comp.

// Returns the rows of group_cells (the kernels of all members from `first` on) processed in this pass.
ivec4 cells_now() {
  const int last = int(lookup.last_row) + (lookup.last_row + 1 == lookup.size ? 1 : 0);
  return ivec4(group_cells.x, max(group_cells.y, int(lookup.first_row)), group_cells.z, min(group_cells.w, last));
}

void look_at_all_cells(ivec4 cells, uint first, uint members_asked) {
  const uint width = uint(cells.z - cells.x + 1), all = width * uint(cells.w - cells.y + 1);
  for (uint k = gl_LocalInvocationIndex; k < all && diverged == 0; k += gl_WorkGroupSize.x) {
    look_at_cell(cells.xy + ivec2(k % width, k / width), first, members_asked);
  }
}

// Nodes wait on a stack; each iteration takes as many from its top as the workgroup has invocations. Of the nodes
// pushed at once (four children for each) the next iteration takes at least a quarter, and nodes pushed above them
// later are a level lower: with 15 levels no more than 14 * 3 + 4 + 1 nodes for each invocation wait.
void look_below_nodes(ivec4 cells, uint first, uint members_asked) {
  const uint whole = tree.header.whole, top = tree.header.top;
  uint root_level = top;
  if (own.traversal == kHierarchy) root_level = pyramid_root_level(uvec2(cells.xy), uvec2(cells.zw), whole, top);
  const uint root_shift = pyramid_shift(root_level, whole);
  const uvec2 origin = (uvec2(cells.xy) >> root_shift) << root_shift;
  const uvec2 roots = ((uvec2(cells.zw) - origin) >> root_level) + 1;
  const uint root_count = roots.x * roots.y;
  uint next_root = 0;
  for (;;) {
    barrier();
    const uint waiting = stack_count;
    if ((waiting == 0 && next_root >= root_count) || diverged != 0) break;
    uvec2 at = origin;
    uint level = root_level;
    bool mine;
    if (waiting == 0) {
      const uint root = next_root + gl_LocalInvocationIndex;
      mine = root < root_count;
      at += uvec2(root % roots.x, root / roots.x) << root_level;
      next_root += gl_WorkGroupSize.x;
    } else {
      const uint taken = min(waiting, gl_WorkGroupSize.x);
      mine = gl_LocalInvocationIndex < taken;
      if (mine) {
        const uint node = stack[waiting - taken + gl_LocalInvocationIndex];
        at += uvec2(node & 0x3fff, node >> 14 & 0x3fff);
        level = node >> 28;
      }
      barrier();
      if (gl_LocalInvocationIndex == 0) stack_count = waiting - taken;
    }
    barrier();
    if (!mine) continue;
    if (level == 0) {
      look_at_cell(ivec2(at), first, members_asked);
      continue;
    }
    ++done.nodes;
    const uint shift = pyramid_shift(level, whole), side = pyramid_nodes(tree.header.cells, shift);
    const uvec2 node = at >> shift;
    const vec2 range = view.far * tree.nodes[tree.header.first[level] + (face.map * side + node.y) * side + node.x];
    const ivec2 lower = max(ivec2(at) - 1, ivec2(0)), upper = min(ivec2(at) + (1 << level) - 1, ivec2(lookup.size) - 1);
    const vec2 limits = thresholds(group, face, lower, upper, view.far);
    // Dmitriev and Uralsky 2007 skip nodes that shade nothing. Nodes completely in shadow contain no contours either,
    // and nodes that project outside the light hide none of it.
    if (range.x >= limits.y) continue;
    if (own.traversal == kHierarchy &&
        (range.y < limits.x || all_beside_light(group, face, lower, upper, range.x, light.lower, light.upper))) {
      continue;
    }
    // Pixels that see a hemicube are processed one by one (choose_members).
    if (own.traversal == kHierarchy && face.axis != 2 &&
        all_beside_light_sideways(pixel_e[members[first]], face, ivec2(at) - 1, ivec2(at) + (1 << level) - 1,
                                  vec2(range.x, min(range.y, limits.y)), light.lower, light.upper)) {
      continue;
    }
    const uint half_width = 1u << (level - 1);
    for (uint k = 0; k < 4; ++k) {
      const uvec2 child = at + uvec2(k & 1, k >> 1) * half_width;
      const ivec2 reach = ivec2(child + half_width - 1);
      if (any(greaterThan(ivec2(child), cells.zw)) || any(lessThan(reach, cells.xy))) continue;
      const uvec2 place = child - origin;
      stack[atomicAdd(stack_count, 1)] = place.x | place.y << 14 | (level - 1) << 28;
    }
  }
  barrier();
  if (gl_LocalInvocationIndex == 0) stack_count = 0;
}

// Finds edges of the current level for `members_asked` members from `first` on; returns false if their contours differ.
bool look_for_edges_of(uint first, uint members_asked) {
  barrier();
  if (gl_LocalInvocationIndex == 0) {
    group_cells = cells_at_level(members[first]);
    group = bounds_of(face, pixel_e[members[first]], pixel_m[members[first]]);
    for (uint i = first; i < first + members_asked; ++i) {
      const ivec4 cells = cells_at_level(members[i]);
      group_cells = ivec4(min(group_cells.xy, cells.xy), max(group_cells.zw, cells.zw));
      group = join(group, bounds_of(face, pixel_e[members[i]], pixel_m[members[i]]));
      pixel_edges[members[i]] = 0;
    }
    diverged = 0;
  }
  for (uint i = gl_LocalInvocationIndex; i < members_asked && kLevels != kFinestLevel; i += gl_WorkGroupSize.x) {
    find_own(members[first + i]);
  }
  barrier();
  const ivec4 cells = cells_now();
  if (!no_cells(cells)) {
    if (own.traversal == kFlat || level() > 0) {
      look_at_all_cells(cells, first, members_asked);
    } else {
      look_below_nodes(cells, first, members_asked);
    }
  }
  barrier();
  return diverged == 0;
}

// Adds the area hidden by contours of the current level, weighted by coarser_part (levels.glsl).
void add_level(uint first, uint members_asked, bool coarser) {
  for (uint i = gl_LocalInvocationIndex; i < members_asked; i += gl_WorkGroupSize.x) {
    const uint pixel = members[first + i];
    const float part = coarser_part(pixel_wanted[pixel]), weight = coarser ? part : 1.0 - part;
    const int inside = pixel_inside[pixel] != 0 && lookup.first_row == 0 ? kContourWhole : 0;
    pixel_levels[pixel] += int(floor(float(inside - pixel_edges[pixel]) * weight + 0.5));
  }
}

// Adds the members' edges on the current face to their sums: of all at once if the members are coherent, else one by
// one.
void look_for_edges() {
  for (uint next = 0; next < member_count;) {
    const bool all = together != 0;
    const uint first = all ? 0 : next, members_asked = all ? member_count : 1;
    bool good = true;
    if (kLevels == kFinestLevel) {
      good = look_for_edges_of(first, members_asked);
    } else {
      bool both = false;
      for (uint i = gl_LocalInvocationIndex; i < members_asked; i += gl_WorkGroupSize.x) pixel_levels[members[first + i]] = 0;
      for (uint i = first; i < first + members_asked; ++i) both = both || coarser_part(pixel_wanted[members[i]]) > 0.0;
      begin_level(finer_level(pixel_wanted[members[first]]));
      good = look_for_edges_of(first, members_asked);
      if (good) add_level(first, members_asked, false);
      if (good && both && level() < kCoarsestLevel) {
        begin_level(level() + 1);
        good = look_for_edges_of(first, members_asked);
        if (good) add_level(first, members_asked, true);
      }
      begin_level(0);
    }
    if (good) {
      for (uint i = gl_LocalInvocationIndex; i < members_asked; i += gl_WorkGroupSize.x) {
        const uint pixel = members[first + i];
        pixel_sum[pixel] += kLevels == kFinestLevel ? -pixel_edges[pixel] : pixel_levels[pixel];
      }
      next += members_asked;
    }
    barrier();
    if (gl_LocalInvocationIndex == 0 && all) {
      together = 0;
      if (good) ++done.shared_packets;
      if (!good) ++done.diverged;
    }
    barrier();
  }
}
