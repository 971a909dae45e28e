// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "vsm/view_sample.glsl"

// First pass of view-sample mapping: light samples decided by each view sample's own plane and the light's plane, and
// the leaves of the tree that the shaft from a block of view samples to the light meets. Where Sintorn et al. rasterise
// footprints in light space, this pass traverses a hierarchy, which needs no light frustum: the light may be anywhere.
// Bounds: docs/view-sample.md.

layout(binding = 5) uniform usamplerBuffer nodes;         // 2 texels for each child: (centre, reference), (half extent,
                                                          // the closed part outside of which everything below is
                                                          // dispensable, or 0)
layout(binding = 6) uniform usamplerBuffer parts;         // 14 texels for each closed part: 7 boxes, that of the part
                                                          // and those of its vertices on each face

shared uint stack[kStackSize];
shared uint leaves[kChunk + kTeam * kTeams + 8];

// Passes the first `count` collected leaves to the second pass.
void emit_chunk(uint header, uint outside_of, uint count) {
  uint chunk = 0;
  if (subgroupElect()) chunk = atomicAdd(chunk_count, 1);
  chunk = subgroupBroadcastFirst(chunk);
  if (chunk >= push.chunk_capacity) return;
  const uint first = chunk * (kChunkHead + kChunk);
  if (gl_SubgroupInvocationID == 0) {
    chunks[first] = header;
    chunks[first + 1] = outside_of;
  }
  uint i = gl_SubgroupInvocationID;
  for (; i < kChunk; i += kLanes) chunks[first + kChunkHead + i] = i < count ? leaves[i] : kNone;
  if (i < kChunk) atomicOr(unfinished, 1u);
}

// Returns integers in the order of the floats, with −0 equal to +0: comparing them flushes nothing to zero.
ivec3 ordered(uvec3 bits) {
  const ivec3 size = ivec3(bits & 0x7fffffffu);
  return mix(size, -size, greaterThan(bits, uvec3(0x7fffffffu)));
}

bool outside_box(ivec3 at, int texel) {
  return any(lessThan(at, ordered(texelFetch(parts, texel).xyz))) || any(greaterThan(at, ordered(texelFetch(parts, texel + 1).xyz)));
}

// Returns a word with bit k set if every view sample that is `on` is outside of part k, or on a face of the part's box
// that the part does not reach there.
uint parts_around(bool on) {
  uint outside_of = 0;
  const ivec3 at = ordered(floatBitsToUint(p));
  for (uint left = push.closed_parts; left != 0; left &= left - 1) {
    const uint part = uint(findLSB(left));
    const int texel = int((part - 1) * 14);
    bool outside = outside_box(at, texel);
    for (int face = 0; face < 6; ++face) {
      const ivec3 bound = ordered(texelFetch(parts, texel + face / 3).xyz);
      outside = outside || (at[face % 3] == bound[face % 3] && outside_box(at, texel + 2 + 2 * face));
    }
    if (subgroupAll(!on || (outside && carrier_part != part))) outside_of |= 1u << part;
  }
  return outside_of;
}

// Pushes the root of this dispatch's part of the tree on the stack. If the tree has a leaf above the part's level
// instead, collects that leaf in the first of the parts that it could belong to. Returns the sizes of stack and leaves.
uvec2 first_of_part() {
  uint node = 0;
  uvec2 sizes = uvec2(1, 0);
  for (uint depth = 0; depth < push.part_levels; ++depth) {
    const uint child = sizes.x == 1 ? node * kTeam + (push.part >> (3 * depth) & 7) : 0;
    const uint reference = texelFetch(nodes, int(child * 2)).w;
    if (sizes.x == 1) {
      const bool leaf = reference != kNone && (reference & kLeafBit) != 0;
      sizes = uvec2(reference == kNone || leaf ? 0 : 1, leaf && push.part >> (3 * depth + 3) == 0 ? 1 : 0);
      node = reference;
    }
  }
  stack[0] = node;                                        // every lane writes the same value
  if (sizes.y == 1) leaves[0] = node & ~kLeafBit;
  return sizes;
}

void walk(bool on, float side, uint header, uint outside_of) {
  const Shaft shaft = make_shaft(on, side);
  const uint lane = gl_SubgroupInvocationID, team = lane / kTeam, member = lane % kTeam;
  const uvec2 sizes = first_of_part();
  uint stack_size = sizes.x, leaf_count = sizes.y;
  subgroupMemoryBarrierShared();
  subgroupBarrier();
  while (stack_size > 0 || leaf_count > 0) {
    // The body is short, because some devices execute all of a loop's body regardless of its branches.
    while (stack_size > 0 && leaf_count < kChunk) {
      const uint taken = min(stack_size, kTeams);
      const uint node = team < taken ? stack[stack_size - 1 - team] : 0;
      stack_size -= taken;
      for (uint turn = 0; turn < kTurns; ++turn) {
        const int texel = int((node * kTeam + turn * kLanes + member) * 2);
        const uvec4 first = texelFetch(nodes, texel), second = texelFetch(nodes, texel + 1);
        const vec3 middle = uintBitsToFloat(first.xyz), half_size = uintBitsToFloat(second.xyz);
        const float at = dot(shaft.axis, middle), spread = dot(abs(shaft.axis), half_size);
        const vec4 least = shaft.nx * middle.x + shaft.ny * middle.y + shaft.nz * middle.z -
                           (abs(shaft.nx) * half_size.x + abs(shaft.ny) * half_size.y + abs(shaft.nz) * half_size.z);
        const bool hit = team < taken && first.w != kNone && (outside_of >> second.w & 1) == 0 && at - spread <= shaft.highest && at + spread >= shaft.lowest &&
                         all(lessThanEqual(least, shaft.beyond));
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
    const uint emitted = min(leaf_count, kChunk);
    if (emitted > 0) emit_chunk(header, outside_of, emitted);
    leaf_count -= emitted;
    for (uint turn = 0; turn < kTurns; ++turn) {          // moves the collected leaves to the front, in order
      const uint i = turn * kLanes + lane, rest = i < leaf_count ? leaves[emitted + i] : 0;
      subgroupMemoryBarrierShared();
      subgroupBarrier();
      if (i < leaf_count) leaves[i] = rest;
      subgroupMemoryBarrierShared();
      subgroupBarrier();
    }
    if (emitted < kChunk && stack_size > 0) break;        // the driver ended the inner loop
  }
  // Some drivers that run on processors end loops after 65535 iterations, which must be reported.
  if (stack_size > 0) atomicOr(unfinished, 1u);
}

void main() {
  const uint block = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  load_view_sample(block);
  for (uint word = 0; word < kSharedWords; ++word) blocked[slot_of(word)] = 0;
  bool on = inside && carrier != kNone;
  bool all_blocked = false;
  const bool first_part = push.part == 0;

  // Condition (2) of docs/definitions.md: p is strictly on an emitting side of the light's plane.
  if (on && abs(level) <= level_error) {
    if (first_part) ask(kAnyTriangle, kAllSamples);
    on = false;
  }
  if (on && push.two_sided == 0 && level < 0.0) {
    all_blocked = true;
    on = false;
  }
  // Condition (1) of docs/definitions.md: the light sample is strictly above the carrier's plane. The part of the light
  // above that plane is bounded by one line. (bound horizon)
  if (on) {
    const vec3 above = vec3(dot(normal, push.u), dot(normal, push.v), dot(normal, towards));
    const float error = 16.0 * kRound * (size1(towards) + size1(push.u) + size1(push.v) + size1(p)) + push.deviation;
    const float span = abs(above.x) + abs(above.y);
    if (above.z + span < -error) {
      all_blocked = true;
      on = false;
    } else if (above.z - span <= error && first_part) {
      mark(HalfPlanes(vec4(-above.x, vec3(0.0)), vec4(-above.y, vec3(0.0)), vec4(-above.z, vec3(1.0)),
                      vec4(error, vec3(kAlwaysError))), kWholeLight, kCarrier);
    }
  }
  const uint words = (push.sample_count + 31) / 32;
  if (inside && first_part) {
    for (uint word = 0; word < words; ++word) {
      masks[pixel * words + word] = all_blocked ? 0 : bits(0, int(min(push.sample_count - 32 * word, 32)) - 1);
    }
    if (on && !take_from_mask()) atomicOr(unfinished, 1u);
  }
  if (push.empty_tree == 0) {
    const uint outside_of = parts_around(on);
    if (subgroupAny(on && level > 0.0)) walk(on && level > 0.0, 1.0, block, outside_of);
    if (subgroupAny(on && level < 0.0)) walk(on && level < 0.0, -1.0, block | kBackBit, outside_of);
  }
}
