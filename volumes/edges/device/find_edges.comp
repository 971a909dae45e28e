// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "volumes/edges/device/edge_scatter.glsl"

// First pass of edge scatter, a workgroup for each block of pixels. The block's view samples are divided into clusters
// at gaps. For each cluster it lists: the edges that the shaft from the cluster to the light meets and that may be
// silhouettes as seen from it; and the triangles that the much thinner shaft to one corner of the light meets. Bounds:
// docs/edge-scatter.md.

layout(constant_id = 2) const uint kStackSize = 64;
layout(constant_id = 3) const uint kCrops = 1;              // 0: also lists edges that are not silhouettes

layout(binding = 3) uniform usamplerBuffer edge_nodes;      // 3 texels for each child: (centre, reference), (half
                                                            // extent, –), cone of normals (axis, cosine)
layout(binding = 4) uniform usamplerBuffer triangle_nodes;  // 2 texels for each child
// Edge records (EdgeTexels), one texel buffer for each member: (a, plane 1), (b, plane 2), (n 1), (anchor 1), (n 2),
// (anchor 2).
layout(binding = 5) uniform usamplerBuffer record_a;
layout(binding = 6) uniform usamplerBuffer record_b;
layout(binding = 7) uniform usamplerBuffer record_n1;
layout(binding = 8) uniform usamplerBuffer record_anchor1;
layout(binding = 9) uniform usamplerBuffer record_n2;
layout(binding = 10) uniform usamplerBuffer record_anchor2;
// Triangles, one texel buffer for each corner: (a, triangle), (b, plane), (c, light whose body the triangle belongs
// to).
layout(binding = 11) uniform usamplerBuffer corner_a;
layout(binding = 12) uniform usamplerBuffer corner_b;
layout(binding = 13) uniform usamplerBuffer corner_c;

const uint kBatch = 24;                                     // leaves handled together
const uint kMostLeaves = kBatch + kTeams * kTeam;           // kBatch, and those that one more iteration adds

shared uint stack[kStackSize];
shared uint leaves[kMostLeaves];
shared uint items[kMostLeaves * kTeam];

// Bounding box of the cluster's view samples.
vec3 middle, half_size;

// Returns whether the whole cluster sees every triangle at the edges below a node from the same side, so that none of
// these edges is a silhouette. A vector d = p − x lies in D ± e, and all normals are within an angle of `cone.xyz`.
// (bound cone)
bool same_side(vec3 center, vec3 extent, vec4 cone) {
  const vec3 d = middle - center, e = half_size + extent;
  const float straight = abs(dot(cone.xyz, d)), aside = length(cross(cone.xyz, d));
  const float sine = sqrt(max(1.0 - cone.w * cone.w, 0.0));
  const float spread = dot(abs(cone.xyz), e) * cone.w + length(e) * sine;
  return straight * cone.w - aside * sine > 1.01 * spread + 0.0001 * length(d) + 64.0 * kRound * push.reach;
}

bool meets(Shaft shaft, vec3 level, vec4 least) {
  return min(level.x, min(level.y, level.z)) <= shaft.highest && max(level.x, max(level.y, level.z)) >= shaft.lowest &&
         all(lessThanEqual(least, shaft.beyond));
}

vec4 along_shaft(Shaft shaft, vec3 x) { return shaft.nx * x.x + shaft.ny * x.y + shaft.nz * x.z; }

bool edge_matters(Shaft shaft, uint slot) {
  const int texel = int(slot);
  const uvec4 t0 = texelFetch(record_a, texel), t1 = texelFetch(record_b, texel), t2 = texelFetch(record_n1, texel);
  const uvec4 t3 = texelFetch(record_anchor1, texel), t4 = texelFetch(record_n2, texel), t5 = texelFetch(record_anchor2, texel);
  const vec3 a = uintBitsToFloat(t0.xyz), b = uintBitsToFloat(t1.xyz);
  const int side1 = side_for_all(uintBitsToFloat(t2.xyz), uintBitsToFloat(t3.xyz), middle, half_size);
  const int side2 = side_for_all(uintBitsToFloat(t4.xyz), uintBitsToFloat(t5.xyz), middle, half_size);
  const bool silhouette = kCrops == 0 || side1 == 2 || side2 == 2 || side1 + side2 != 0;
  const vec2 level = vec2(dot(axis, a), dot(axis, b));
  return t2.w != 0 && silhouette && meets(shaft, level.xyy, min(along_shaft(shaft, a), along_shaft(shaft, b)));
}

bool triangle_matters(Shaft shaft, uint slot) {
  const int texel = int(slot);
  const uvec4 t0 = texelFetch(corner_a, texel), t1 = texelFetch(corner_b, texel), t2 = texelFetch(corner_c, texel);
  const vec3 a = uintBitsToFloat(t0.xyz), b = uintBitsToFloat(t1.xyz), c = uintBitsToFloat(t2.xyz);
  const vec4 least = min(along_shaft(shaft, a), min(along_shaft(shaft, b), along_shaft(shaft, c)));
  return t0.w != kNone && t2.w != push.light && meets(shaft, vec3(dot(axis, a), dot(axis, b), dot(axis, c)), least);
}

// More words than any buffer has. The counter of a list that grows without limit stays here and never wraps to 0.
const uint kTooMany = 0xc0000000u;

// Writes the collected items as a piece in front of the list.
uint emit(uint next, uint count) {
  uint first = 0;
  if (subgroupElect()) {
    first = atomicAdd(list_words, count + 2);
    if (first >= kTooMany) atomicExchange(list_words, kTooMany);
  }
  first = subgroupBroadcastFirst(first);
  if (first >= push.list_capacity || count + 2 > push.list_capacity - first) return kNone;
  if (gl_SubgroupInvocationID == 0) {
    lists[first] = next;
    lists[first + 1] = count;
  }
  uint i = gl_SubgroupInvocationID;
  for (; i < count; i += kLanes) lists[first + 2 + i] = items[i];
  if (i < count) atomicOr(unfinished, 1u);
  return first;
}

// Pushes the root of this dispatch's part of a hierarchy on the stack. If the hierarchy has a leaf above the part's
// level instead, collects that leaf in the first of the parts that it could belong to. Returns the sizes of stack and
// leaves.
uvec2 first_of_part(bool edges) {
  uint node = edges ? push.edge_root : 0;
  uvec2 sizes = uvec2(1, 0);
  for (uint level = 0; level < push.part_levels; ++level) {
    const int child = sizes.x == 1 ? int(node * kTeam + (push.part >> (3 * level) & 7)) : 0;
    const uint reference = edges ? texelFetch(edge_nodes, 3 * child).w : texelFetch(triangle_nodes, 2 * child).w;
    if (sizes.x == 1) {
      const bool leaf = reference != kNone && (reference & kLeafBit) != 0;
      sizes = uvec2(reference == kNone || leaf ? 0 : 1, leaf && push.part >> (3 * level + 3) == 0 ? 1 : 0);
      node = reference;
    }
  }
  stack[0] = node;                                        // every lane writes the same value
  if (sizes.y == 1) leaves[0] = node & ~kLeafBit;
  return sizes;
}

// Traverses a hierarchy and adds to the list `head`; returns the new head.
uint walk(Shaft shaft, bool edges, uint head) {
  const uint lane = gl_SubgroupInvocationID, team = lane / kTeam, member = lane % kTeam;
  const uvec2 sizes = first_of_part(edges);
  uint stack_size = sizes.x, known_leaves = sizes.y;
  while (stack_size + known_leaves > 0) {
    uint leaf_count = known_leaves, item_count = 0, i = 0;
    known_leaves = 0;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    // The body is short, because some devices execute all of a loop's body regardless of its branches.
    while (stack_size > 0 && leaf_count < kBatch) {
      const uint taken = min(stack_size, kTeams);
      const uint node = team < taken ? stack[stack_size - 1 - team] : 0;
      stack_size -= taken;
      for (uint turn = 0; turn < kTurns; ++turn) {
        const int child = int(node * kTeam + turn * kLanes + member);
        const uvec4 first = edges ? texelFetch(edge_nodes, 3 * child) : texelFetch(triangle_nodes, 2 * child);
        const uvec4 second = edges ? texelFetch(edge_nodes, 3 * child + 1) : texelFetch(triangle_nodes, 2 * child + 1);
        const uvec4 third = edges ? texelFetch(edge_nodes, 3 * child + 2) : uvec4(0);
        const vec3 center = uintBitsToFloat(first.xyz), extent = uintBitsToFloat(second.xyz);
        const float at = dot(axis, center), spread = dot(abs(axis), extent);
        const vec4 least = along_shaft(shaft, center) - (abs(shaft.nx) * extent.x + abs(shaft.ny) * extent.y + abs(shaft.nz) * extent.z);
        const bool met = team < taken && first.w != kNone && at - spread <= shaft.highest && at + spread >= shaft.lowest &&
                         all(lessThanEqual(least, shaft.beyond));
        const bool hit = met && !(edges && kCrops != 0 && same_side(center, extent, uintBitsToFloat(third)));
        const bool leaf = (first.w & kLeafBit) != 0;
        const uvec4 inner_hits = subgroupBallot(hit && !leaf), leaf_hits = subgroupBallot(hit && leaf);
        subgroupMemoryBarrierShared();
        subgroupBarrier();
        if (hit && !leaf) stack[stack_size + subgroupBallotExclusiveBitCount(inner_hits)] = first.w;
        if (hit && leaf) leaves[leaf_count + subgroupBallotExclusiveBitCount(leaf_hits)] = first.w & ~kLeafBit;
        stack_size += subgroupBallotBitCount(inner_hits);
        leaf_count += subgroupBallotBitCount(leaf_hits);
        subgroupMemoryBarrierShared();
        subgroupBarrier();
      }
    }
    const uint end = leaf_count * kTurns;
    for (; i < end; i += kTeams) {                          // the teams take one round of a leaf's slots after the
                                                            // other, leaf by leaf
      const uint number = i / kTurns + team;
      const bool used = number < leaf_count;
      const uint slot = (used ? leaves[number] : 0) * kTeam + i % kTurns * kLanes + member;
      const bool kept = used && (edges ? edge_matters(shaft, slot) : triangle_matters(shaft, slot));
      const uvec4 all_kept = subgroupBallot(kept);
      if (kept) items[item_count + subgroupBallotExclusiveBitCount(all_kept)] = slot;
      item_count += subgroupBallotBitCount(all_kept);
    }
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    if (item_count > 0) head = emit(head, item_count);
    // Some drivers that run on processors end loops after 65535 iterations, which must be reported.
    if (i < end || (stack_size > 0 && leaf_count < kBatch)) {
      atomicOr(unfinished, 1u);
      break;
    }
  }
  if (stack_size > 0) atomicOr(unfinished, 1u);
  return head;
}

// This lane's view samples have the indices lane, lane + kLanes … in the block; their clusters take two bits each.
const uint kEach = kBlock * kBlock / kLanes;
uint cluster_of_each, on_each;
vec3 place_of[kEach];

uint cluster_of(uint i) { return cluster_of_each >> (2 * i) & 3; }
bool is_on(uint i) { return (on_each >> i & 1) != 0; }

uint pixel_of(uint i, uint block) {
  const uint blocks_across = (push.width + kBlock - 1) / kBlock, number = i * kLanes + gl_SubgroupInvocationID;
  const uvec2 at = uvec2(block % blocks_across, block / blocks_across) * kBlock + uvec2(number % kBlock, number / kBlock);
  return at.x < push.width && at.y < push.row_count ? at.y * push.width + at.x : kNone;
}

// Divides a cluster at the middle of its box, if its view samples leave a gap there of more than a third of the box.
// Returns whether it did.
bool split(uint cluster, uint new_cluster) {
  vec3 lower = vec3(1e30), upper = vec3(-1e30);
  for (uint i = 0; i < kEach; ++i) {
    if (!is_on(i) || cluster_of(i) != cluster) continue;
    const vec3 p = place_of[i];
    lower = min(lower, p);
    upper = max(upper, p);
  }
  lower = subgroupMin(lower);
  upper = subgroupMax(upper);
  const vec3 size = upper - lower;
  const vec3 pick = size.x >= size.y && size.x >= size.z ? vec3(1, 0, 0) : size.y >= size.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
  const float extent = dot(pick, size), cut = dot(pick, 0.5 * lower + 0.5 * upper);
  float below = -1e30, above = 1e30;
  for (uint i = 0; i < kEach; ++i) {
    if (!is_on(i) || cluster_of(i) != cluster) continue;
    const float x = dot(pick, place_of[i]);
    if (x < cut) below = max(below, x);
    if (x >= cut) above = min(above, x);
  }
  below = subgroupMax(below);
  above = subgroupMin(above);
  if (!(above - below > 0.34 * extent) || below < -1e29 || above > 1e29) return false;
  for (uint i = 0; i < kEach; ++i) {
    if (!is_on(i) || cluster_of(i) != cluster) continue;
    if (dot(pick, place_of[i]) >= cut) {
      cluster_of_each = (cluster_of_each & ~(3u << (2 * i))) | new_cluster << (2 * i);
    }
  }
  return true;
}

void list_for(uint cluster, uint block) {
  const vec2 low = -half_cells;
  vec3 lower = vec3(1e30), upper = vec3(-1e30);
  vec4 slopes = vec4(-1e18), corner_slopes = vec4(-1e18);
  float height = 0.0;
  for (uint i = 0; i < kEach; ++i) {
    if (!is_on(i) || cluster_of(i) != cluster) continue;
    const ViewSample it = view_sample_at(place_of[i]);
    lower = min(lower, it.p);
    upper = max(upper, it.p);
    slopes = max(slopes, slopes_of(low, half_cells, it.foot, it.height));
    corner_slopes = max(corner_slopes, slopes_of(low, low, it.foot, it.height));
    height = max(height, it.height);
  }
  lower = subgroupMin(lower);
  upper = subgroupMax(upper);
  slopes = subgroupMax(slopes);
  corner_slopes = subgroupMax(corner_slopes);
  height = subgroupMax(height);
  middle = 0.5 * lower + 0.5 * upper;
  half_size = (0.5 * upper - 0.5 * lower) * (1.0 + 8.0 * kRound);
  const uint place = 2 * (block * kClusters + cluster);
  const bool first_part = push.part == 0;                 // other parts continue the lists of the first
  uint edges = first_part ? kNone : heads[place], triangles = first_part ? kNone : heads[place + 1];
  if (push.edge_depth > 0) edges = walk(make_shaft(low, half_cells, slopes, height), true, edges);
  if (push.triangle_depth > 0) triangles = walk(make_shaft(low, low, corner_slopes, height), false, triangles);
  if (gl_SubgroupInvocationID == 0) {
    heads[place] = edges;
    heads[place + 1] = triangles;
  }
}

void main() {
  make_frame();
  const uint block = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  cluster_of_each = 0;
  on_each = 0;
  for (uint i = 0; i < kEach; ++i) {
    const uint pixel = pixel_of(i, block);
    const ViewSample it = fetch_view_sample(pixel == kNone ? 0 : pixel);
    place_of[i] = it.p;
    // Factor 0.5: a compiler may round level_error differently in the passes that use these lists.
    if (pixel != kNone && it.carrier != kNone && it.height > 0.5 * level_error(it.p)) on_each |= 1u << i;
  }
  if (!subgroupAny(on_each != 0)) return;
  uint clusters = 1;
  if (split(0, 1)) {
    clusters = 2;
    if (split(0, 2)) clusters = 3;
    if (clusters == 3) {
      if (split(1, 3)) clusters = 4;
    } else if (split(1, 2)) {
      clusters = 3;
    }
  }
  for (uint i = 0; i < kEach; ++i) {
    const uint pixel = pixel_of(i, block);
    if (pixel != kNone) heads[2 * kClusters * block_count() + pixel] = cluster_of(i);
  }
  for (uint cluster = 0; cluster < clusters; ++cluster) list_for(cluster, block);
}
