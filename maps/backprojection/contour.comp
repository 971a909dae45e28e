#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/backprojection/contour.shared.h"
#define GROUP_A_PACKET
#define OWN_PUSH ContourPush
#include "maps/host/look_up.glsl"
#include "maps/host/group_kernel.glsl"
#define LIGHT 5
#include "maps/backprojection/radial.glsl"
#define PYRAMID_BINDING 6
#include "maps/products/depth_pyramid.glsl"
#include "maps/backprojection/thresholds.glsl"

// Occluder contours (Guennebaud, Barthe and Paulin 2007), found below nodes of a pyramid and for packets of pixels (Yang
// et al. 2009). A workgroup, one subgroup wide, answers a packet of w x h pixels, or a single one.
//
// The texels of a map that shade a receiver are parted from the others by marching squares on the dual grid, between
// texels' centres; a vertex lies midway, at the depth of the texel that shades. Seen from the receiver it falls onto the
// light, along the ray from the light's centre that leads away from the receiver's own direction. So what the receiver's
// own direction is in (1 or 0, `inside`) less the signed areas beyond the edges (radial.glsl) is what the contours hide:
//   hidden = inside - sum turn * beyond
// Texels beyond a face are empty, so contours close on every face: where a shape goes on across two faces of a hemicube
// its parts share the border, up to what two texels' depths differ there.
//
// `inside` and `turn` of the edges in the receiver's own cell come from one predicate on one set of numbers: neither
// texels' answers nor a second formula will do, for the light's whole area depends on them.

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };
layout(scalar, binding = 7) readonly buffer Tree {  // the pyramid that is walked; that of `Pyramid`, or another
  PyramidHeader header;
  vec2 nodes[];
} tree;
layout(scalar, binding = 8) buffer Work { uint work[]; };

// ---- the packet at hand ----
shared vec3 pixel_e[kMostPacketPixels], pixel_m[kMostPacketPixels];
shared uint pixel_state[kMostPacketPixels];
shared int pixel_sum[kMostPacketPixels];   // inside - sum, in parts of kContourWhole
shared int pixel_edges[kMostPacketPixels];  // the sum that is being added up
shared ivec4 pixel_cells[kMostPacketPixels];  // first and last cells of its kernel on the face at hand
shared ivec2 pixel_own[kMostPacketPixels];    // the light's centre is seen between this texel's centre and the next ones
shared vec2 pixel_at[kMostPacketPixels];      // so far from that centre, in texels
const uint kLit = 2, kBehind = 3;             // states; 0 and 1: asks, on that side of the light's plane

// ---- pixels that are answered together: all of a packet that have cells to look at, or one of them ----
shared uint members[kMostPacketPixels];
shared uint member_count, together;
shared Bounds group;
shared ivec4 group_cells;

shared uint stack[gl_WorkGroupSize.x * 48];
shared uint stack_count, diverged;
shared uint work_done[kWorkCounts];

LightView view;
uint side_number;
MapFace face;
uint face_number;
float face_turn;  // -1 where a turn to the left in the face is one to the right on the light
WorkNumbers done;  // by this invocation

// ---- contours ----
// A cell's corners, counted x + 2 y, and its sides: bottom, right, top, left. For each set of shading corners two edges
// from side to side, the shading ones to their left: from | to << 2, and 16 if there is one. Corners that shade across a
// diagonal are apart.
const uint kEdges[16] = uint[16](0x0000, 0x001c, 0x0011, 0x001d, 0x001b, 0x0018, 0x1b11, 0x0019, 0x0016, 0x161c, 0x0012,
                                 0x001e, 0x0017, 0x0014, 0x0013, 0x0000);
const vec2 kSide[4] = vec2[4](vec2(0.5, 0.0), vec2(1.0, 0.5), vec2(0.5, 1.0), vec2(0.0, 0.5));

bool on_map(ivec2 texel) { return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(lookup.size))); }

bool shades(uint pixel, ivec2 texel) {
  Tap tap = tap_of(view, lookup.size, face, uvec2(texel));
  tap.along = pixel_e[pixel].z / tap.direction.z;
  return tap.depth < view.far && blocks_light(tap, pixel_e[pixel], pixel_m[pixel], lookup.bias);
}

// A receiver's own face of a side with so many.
uint own_face(uint faces, vec3 e) {
  const vec2 across = abs(e.xy);
  if (faces == 1 || max(across.x, across.y) <= e.z) return 0;
  return across.x >= across.y ? (e.x > 0.0 ? 1 : 2) : (e.y > 0.0 ? 3 : 4);
}

// A vertex from where a face sees the light's centre, in texels.
vec2 from_own(uint pixel, ivec2 base, uint side) { return vec2(base - pixel_own[pixel]) + kSide[side] - pixel_at[pixel]; }

// Where a receiver sees a vertex on the light.
vec2 vertex_on_light(uint pixel, bool own_here, ivec2 base, uint side, float depth) {
  const vec3 e = pixel_e[pixel];
  if (face.axis == 2 && own_here) return from_own(pixel, base, side) * face.texel * (depth * e.z / (e.z - depth));
  const vec2 at = face.lower + (vec2(base) + kSide[side] + 0.5) * face.texel;
  const vec3 s = onto_light(e, depth * from_face(face, vec3(at, 1.0)));
  // Sideways, a texel's far end may be beyond the receiver's height: then it is seen as far away as can be.
  return s.xy / max(s.z, kSlack * e.z);
}

void add_edge(uint pixel, ivec2 base, uint edge, float depth_from, float depth_to) {
  const uint from = edge & 3, to = edge >> 2 & 3;
  const bool own_here = own_face(view.side[side_number].face_count, pixel_e[pixel]) == face_number;
  const vec2 a = vertex_on_light(pixel, own_here, base, from, depth_from);
  const vec2 b = vertex_on_light(pixel, own_here, base, to, depth_to);
  const float turned = own_here ? cross2(from_own(pixel, base, from), from_own(pixel, base, to)) : face_turn * cross2(a, b);
  const float turn = turned >= 0.0 ? 1.0 : -1.0;
  const float area = beyond_edge(to_unit(a), to_unit(b), turn * face_turn);
  atomicAdd(pixel_edges[pixel], int(turn) * int(area * float(kContourWhole) + 0.5));
}

// The edges of a cell, for all members from first on.
void look_at_cell(ivec2 cell, uint first, uint members_asked) {
  ++done.cells;
  const ivec2 base = cell - 1;
  const vec2 limits = thresholds(group, face, max(base, ivec2(0)), min(cell, ivec2(lookup.size) - 1), view.far);
  uint corners = 0;
  vec4 depths;
  bool differs = false;
  for (int k = 0; k < 4; ++k) {
    const ivec2 texel = base + ivec2(k & 1, k >> 1);
    depths[k] = view.far;
    if (!on_map(texel)) continue;
    depths[k] = view.far * maps[(face.map * lookup.size + uint(texel.y)) * lookup.size + uint(texel.x)];
    if (depths[k] >= limits.y) continue;
    uint shaded = members_asked;
    if (depths[k] >= limits.x) {  // near some receiver's own depth
      shaded = 0;
      for (uint i = 0; i < members_asked; ++i) shaded += shades(members[first + i], texel) ? 1 : 0;
    }
    if (shaded == members_asked) corners |= 1u << k;
    differs = differs || (shaded > 0 && shaded < members_asked);
  }
  if (differs) {
    diverged = 1;
    return;
  }
  for (uint edges = kEdges[corners]; edges != 0; edges >>= 8) {
    ++done.edges;
    // On each side the corner that shades, and its depth.
    vec2 depth;
    for (int end = 0; end < 2; ++end) {
      const uint side = edges >> (2 * end) & 3;
      const uint one = side == 1 ? 1 : side == 2 ? 2 : 0, other = side == 0 ? 1 : side == 3 ? 2 : 3;
      depth[end] = (corners >> one & 1) != 0 ? depths[one] : depths[other];
    }
    for (uint i = 0; i < members_asked; ++i) add_edge(members[first + i], base, edges, depth.x, depth.y);
  }
}

// ---- kernels ----
bool no_cells(ivec4 cells) { return cells.z < cells.x || cells.w < cells.y; }

// The cells that a kernel's texels touch: between any texels of it, and one more before and behind.
ivec4 cells_of(Kernel kernel) {
  return all(lessThanEqual(kernel.first, kernel.last)) ? ivec4(kernel.first, kernel.last + 1) : ivec4(0, 0, -1, -1);
}

// Guennebaud 2006: what the nearest depth in the kernel cannot hide is out of it, and so on; with nothing before the
// receiver, or nothing but what shades it, there is no contour.
void find_kernel(uint pixel) {
  const vec3 e = pixel_e[pixel];
  ivec4 cells = cells_of(kernel_on(face, lookup.size, e, light.lower, light.upper, nearest[side_number], 0));
  const Bounds alone = bounds_of(face, e, pixel_m[pixel]);
  for (uint round = 0; round < 4 && own.search != kNoSearch && !no_cells(cells); ++round) {
    const vec2 range = view.far * depth_range_of_cells(face.map, uvec2(cells.xy), uvec2(cells.zw));
    const vec2 limits = thresholds(alone, face, max(cells.xy - 1, 0), min(cells.zw, ivec2(lookup.size) - 1), view.far);
    if (range.x >= limits.y || range.y < limits.x) {
      cells = ivec4(0, 0, -1, -1);
    } else if (face.axis == 2) {
      const ivec4 narrow = cells_of(kernel_on(face, lookup.size, e, light.lower, light.upper, range.x, 0));
      if (no_cells(narrow)) {
        cells = narrow;
        break;
      }
      const ivec4 within = ivec4(max(narrow.xy, cells.xy), min(narrow.zw, cells.zw));
      if (within == cells) break;
      cells = within;
    }
  }
  pixel_cells[pixel] = cells;

  if (own_face(view.side[side_number].face_count, e) != face_number) return;
  const vec3 f = to_face(face, e);
  const vec2 g = (f.xy / f.z - face.lower) / face.texel - 0.5;
  const vec2 first = clamp(floor(g), vec2(-1.0), vec2(float(lookup.size) - 1.0));
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
  if (inside && lookup.first_row == 0) pixel_sum[pixel] += kContourWhole;
}

// ---- packets ----
// Yang 2009, equations 4 to 6, for members with kernels that lie in `cells` together: will they have the same contours,
// and is it cheaper to look for them once? Costs of a node, an edge and an area, as measured (docs/packet.md).
const float kNodeCost = 1.0, kEdgeCost = 1.0, kAreaCost = 1.0;

bool is_coherent(ivec4 cells) {
  const vec2 extent = vec2(cells.zw - cells.xy + 1);
  float apart = 0.0;
  float own_cost = 0.0;
  vec2 heights = vec2(1e30, 0.0);
  for (uint i = 0; i < member_count; ++i) {
    const ivec4 mine = pixel_cells[members[i]];
    const float width = sqrt(float(mine.z - mine.x + 1) * float(mine.w - mine.y + 1));
    own_cost += (kNodeCost * log2(width) + kEdgeCost + kAreaCost) * width;
    const float z = pixel_e[members[i]].z;
    heights = vec2(min(heights.x, z), max(heights.y, z));
  }
  const float width = sqrt(extent.x * extent.y);
  const float cost = (kNodeCost * log2(width) + kEdgeCost + kAreaCost * float(member_count)) * width;
  if (own.search != kNoSearch) {
    const vec2 range = view.far * depth_range_of_cells(face.map, uvec2(cells.xy), uvec2(cells.zw));
    const float shared_range = max(0.0, min(heights.y, range.y) - max(heights.x, range.x));
    const float null_share = range.y > range.x ? shared_range / (range.y - range.x) : 0.0;
    apart = 1.0 - pow(max(0.0, 1.0 - null_share), extent.x * extent.y);
  }
  return apart <= own.divergence && cost <= own_cost;
}

// Of the pixels on this side those with cells to look at on this face.
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
  if (view.side[side_number].face_count == 1 && is_coherent(cells)) together = 1;
  if (together == 0) ++done.parted;
}

// ---- looking for edges ----
// All members from first on have their kernels in group_cells, of which these are the rows that are looked at now.
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

// Nodes wait on a stack, from whose top the workgroup takes as many at a time as it has invocations. Of what is pushed
// at once (four children for each) the next turn takes at least a quarter, and whatever is pushed above it later is a
// level lower: with 15 levels no more than 14 * 3 + 4 + 1 nodes for each invocation wait.
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
    const ivec2 last_cell = ivec2(at) + (1 << level) - 1;
    const vec2 limits =
        thresholds(group, face, max(ivec2(at) - 1, ivec2(0)), min(last_cell, ivec2(lookup.size) - 1), view.far);
    // Dmitriev and Uralsky 2007 leave out what shades nothing; contours are not in what is all in shadow, either.
    if (range.x >= limits.y || (own.traversal == kHierarchy && range.y < limits.x)) continue;
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

// Adds the members' edges on the face at hand to their sums: of all at once if they are coherent, else one by one.
void look_for_edges() {
  for (uint next = 0; next < member_count;) {
    const bool all = together != 0;
    const uint first = all ? 0 : next, members_asked = all ? member_count : 1;
    if (gl_LocalInvocationIndex == 0) {
      group_cells = pixel_cells[members[first]];
      group = bounds_of(face, pixel_e[members[first]], pixel_m[members[first]]);
      for (uint i = first; i < first + members_asked; ++i) {
        const ivec4 cells = pixel_cells[members[i]];
        group_cells = ivec4(min(group_cells.xy, cells.xy), max(group_cells.zw, cells.zw));
        group = join(group, bounds_of(face, pixel_e[members[i]], pixel_m[members[i]]));
        pixel_edges[members[i]] = 0;
      }
      diverged = 0;
    }
    barrier();
    const ivec4 cells = cells_now();
    if (!no_cells(cells)) {
      if (own.traversal == kFlat) {
        look_at_all_cells(cells, first, members_asked);
      } else {
        look_below_nodes(cells, first, members_asked);
      }
    }
    barrier();
    const bool good = diverged == 0;
    if (good) {
      for (uint i = gl_LocalInvocationIndex; i < members_asked; i += gl_WorkGroupSize.x) {
        pixel_sum[members[first + i]] -= pixel_edges[members[first + i]];
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

// ---- the packet ----
// The receiver of a pixel of this packet; false beyond the picture.
bool receiver_of(uint pixel, out uint receiver) {
  const uint group_index = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint across = (lookup.width + own.packet_width - 1) / own.packet_width;
  const uint x = group_index % across * own.packet_width + pixel % own.packet_width;
  const uint y = group_index / across * own.packet_height + pixel / own.packet_width;
  receiver = y * lookup.width + x;
  return x < lookup.width && receiver < lookup.receiver_count;
}

void load_pixel(uint pixel) {
  pixel_state[pixel] = kLit;
  pixel_sum[pixel] = 0;
  uint number;
  if (!receiver_of(pixel, number)) return;
  const Receiver receiver = receivers[lookup.first_receiver + number];
  if (receiver.n == vec3(0.0)) return;
  const vec3 d = to_basis(lookup.basis, receiver.p - view.point), m = -to_basis(lookup.basis, receiver.n);
  pixel_e[pixel] = vec3(d.xy, abs(d.z));
  pixel_m[pixel] = d.z < 0.0 ? vec3(m.xy, -m.z) : m;
  pixel_state[pixel] = !on_emitting_side(d) ? kBehind : d.z < 0.0 ? 1 : 0;
  if (lookup.first_row > 0) pixel_sum[pixel] = int(results[lookup.first_result + number]);
}

void store_pixel(uint pixel) {
  uint number;
  if (!receiver_of(pixel, number)) return;
  const uint result = lookup.first_result + number;
  if (lookup.last_row + 1 < lookup.size) {
    results[result] = uint(pixel_sum[pixel]);
    return;
  }
  float v = pixel_state[pixel] == kBehind ? 0.0 : 1.0;
  if (pixel_state[pixel] < kLit) {
    const float hidden = float(clamp(pixel_sum[pixel], 0, kContourWhole)) / float(kContourWhole);
    v = min(1.0 - hidden, light_above_horizon(pixel_e[pixel], pixel_m[pixel]));
  }
  results[result] = floatBitsToUint(v);
}

void count_work(uint kind, uint amount) { atomicAdd(work_done[kind], amount); }

void main() {
  const uint pixels = own.packet_width * own.packet_height;
  view = views[0];
  done = WorkNumbers(0, 0, 0, 0, 0, 0, 0, 0);
  if (gl_LocalInvocationIndex == 0) stack_count = diverged = 0;
  for (uint k = gl_LocalInvocationIndex; k < kWorkCounts; k += gl_WorkGroupSize.x) work_done[k] = 0;
  for (uint i = gl_LocalInvocationIndex; i < pixels; i += gl_WorkGroupSize.x) load_pixel(i);
  barrier();

  uint looked_for = 0;
  for (side_number = 0; side_number < 1 + lookup.two_sided; ++side_number) {
    for (face_number = 0; face_number < view.side[side_number].face_count; ++face_number) {
      face = face_of(view.side[side_number], 0, lookup.size, face_number);
      face_turn = face.axis == 2 ? 1.0 : face.axis == 0 ? face.sign : -face.sign;
      for (uint i = gl_LocalInvocationIndex; i < pixels; i += gl_WorkGroupSize.x) {
        if (pixel_state[i] == side_number) find_kernel(i);
      }
      barrier();
      if (gl_LocalInvocationIndex == 0) choose_members(pixels);
      barrier();
      looked_for += member_count;
      look_for_edges();
    }
  }
  if (gl_LocalInvocationIndex == 0 && looked_for == 0) ++done.trivial;

  for (uint i = gl_LocalInvocationIndex; i < pixels; i += gl_WorkGroupSize.x) store_pixel(i);
  count_work(0, done.nodes);
  count_work(1, done.cells);
  count_work(2, done.edges);
  count_work(3, done.shared_packets);
  count_work(4, done.parted);
  count_work(5, done.diverged);
  count_work(6, done.trivial);
  count_work(7, done.kernel_cells);
  barrier();
  for (uint k = gl_LocalInvocationIndex; k < kWorkCounts; k += gl_WorkGroupSize.x) {
    const uint amount = work_done[k];
    if (amount != 0 && atomicAdd(work[2 * k], amount) + amount < amount) atomicAdd(work[2 * k + 1], 1);
  }
  check_that_loops_ended();
}
