#version 460
#extension GL_GOOGLE_include_directive : require
#include "vsm/view_sample.glsl"

// First pass of view-sample mapping: what each view sample's own plane and the light's plane decide, and the leaves of
// the tree that the shaft from a block of view samples to the light meets. Where Sintorn et al. rasterise footprints in
// light space, we walk a hierarchy: that needs no light frustum, and the light may be anywhere.

layout(binding = 5) uniform usamplerBuffer nodes;         // 2 texels a child: (centre, reference), (half extent, -)

shared uint stack[kStackSize];
shared uint leaves[kChunk + 8 * (kLanes / 8) + 8];

// Hands the first `count` collected leaves to the second pass.
void emit_chunk(uint header, uint count) {
  uint chunk = 0;
  if (subgroupElect()) chunk = atomicAdd(chunk_count, 1);
  chunk = subgroupBroadcastFirst(chunk);
  if (chunk >= push.chunk_capacity) return;
  const uint first = chunk * (1 + kChunk);
  if (gl_SubgroupInvocationID == 0) chunks[first] = header;
  for (uint i = gl_SubgroupInvocationID; i < kChunk; i += kLanes) chunks[first + 1 + i] = i < count ? leaves[i] : kNone;
}

void walk(bool on, float side, uint header) {
  const Shaft shaft = make_shaft(on, side);
  const uint lane = gl_SubgroupInvocationID, teams = kLanes / kTeam, team = lane / kTeam, member = lane % kTeam;
  uint stack_size = 1, leaf_count = 0;
  stack[0] = 0;                                           // every lane writes the same
  while (stack_size > 0 || leaf_count > 0) {
    // Short, because some devices run all of a loop's body whatever its branches say.
    while (stack_size > 0 && leaf_count < kChunk) {
      const uint taken = min(stack_size, teams);
      const uint node = team < taken ? stack[stack_size - 1 - team] : 0;
      stack_size -= taken;
      const int texel = int((node * kTeam + member) * 2);
      const uvec4 first = texelFetch(nodes, texel), second = texelFetch(nodes, texel + 1);
      const vec3 middle = uintBitsToFloat(first.xyz), half_size = uintBitsToFloat(second.xyz);
      const float at = dot(shaft.axis, middle), spread = dot(abs(shaft.axis), half_size);
      const vec4 least = shaft.nx * middle.x + shaft.ny * middle.y + shaft.nz * middle.z -
                         (abs(shaft.nx) * half_size.x + abs(shaft.ny) * half_size.y + abs(shaft.nz) * half_size.z);
      const bool hit = team < taken && first.w != kNone && at - spread <= shaft.highest && at + spread >= shaft.lowest &&
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
    const uint emitted = min(leaf_count, kChunk);
    if (emitted > 0) emit_chunk(header, emitted);
    leaf_count -= emitted;
    const uint rest = lane < leaf_count ? leaves[emitted + lane] : 0;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    if (lane < leaf_count) leaves[lane] = rest;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    if (emitted < kChunk && stack_size > 0) break;        // the inner loop was cut off
  }
  // Some processors' drivers end loops after 65535 turns. Never go on as if nothing had happened.
  if (stack_size > 0) atomicOr(unfinished, kWalkCut);
}

void main() {
  const uint block = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  load_view_sample(block);
  for (uint word = 0; word < kSharedWords; ++word) blocked[slot_of(word)] = 0;
  bool on = inside && carrier != kNone;
  bool all_blocked = false;

  // (2) p strictly on an emitting side of the light's plane.
  if (on && abs(level) <= level_error) {
    ask(kWholePixel, kAllSamples);
    on = false;
  }
  if (on && push.two_sided == 0 && level < 0.0) {
    all_blocked = true;
    on = false;
  }
  // (1) The light sample strictly above the carrier's plane: one half-plane of the light. (bound horizon)
  if (on) {
    const vec3 above = vec3(dot(normal, push.u), dot(normal, push.v), dot(normal, towards));
    const float error = 16.0 * kRound * (size1(towards) + size1(push.u) + size1(push.v) + size1(p)) + push.deviation;
    const float span = abs(above.x) + abs(above.y);
    if (above.z + span < -error) {
      all_blocked = true;
      on = false;
    } else if (above.z - span <= error) {
      mark(HalfPlanes(vec4(-above.x, vec3(0.0)), vec4(-above.y, vec3(0.0)), vec4(-above.z, vec3(1.0)),
                      vec4(error, vec3(kAlwaysError))), kWholeLight, kCarrier);
    }
  }
  const uint words = (push.sample_count + 31) / 32;
  if (inside) {
    for (uint word = 0; word < words; ++word) {
      masks[pixel * words + word] = all_blocked ? bits(0, int(min(push.sample_count - 32 * word, 32)) - 1) : 0;
    }
    if (on) add_to_mask();
  }
  if (push.empty_tree == 0) {
    if (subgroupAny(on && level > 0.0)) walk(on && level > 0.0, 1.0, block);
    if (subgroupAny(on && level < 0.0)) walk(on && level < 0.0, -1.0, block | kBackBit);
  }
}
