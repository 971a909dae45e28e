#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "volumes/edges/facing.shared.h"

// On which side of every triangle is every point? One workgroup: 32 triangles (a word of the bit planes) and a stretch of
// points, one lane a few of them. A sign counts only beyond its error bound (README.md, Bounds); what does not is set in
// both planes, and the word is put on a list for the host. No branch on the way: devices that run both sides of one
// anyway lose nothing.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Triangles { FacingTriangle triangles[]; };
layout(scalar, binding = 1) readonly buffer Points { FacingPoint points[]; };
layout(scalar, binding = 2) writeonly buffer Front { uint front[]; };
layout(scalar, binding = 3) writeonly buffer Back { uint back[]; };
layout(scalar, binding = 4) buffer Undecided {
  uint undecided_count;
  UndecidedWord undecided[];
};
layout(scalar, push_constant) uniform Push { FacingPush push; };

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint word = group / push.point_groups;
  if (word >= push.word_count) return;
  const uint first = (group % push.point_groups) * kLanes * kPointsPerLane + gl_LocalInvocationID.x;

  FacingPoint own[kPointsPerLane];
  uint front_bits[kPointsPerLane], back_bits[kPointsPerLane];
  for (uint k = 0; k < kPointsPerLane; ++k) {
    own[k] = points[min(first + k * kLanes, push.point_count - 1)];
    front_bits[k] = back_bits[k] = 0;
  }
  for (uint i = 0; i < 32; ++i) {
    const FacingTriangle t = triangles[word * 32 + i];
    for (uint k = 0; k < kPointsPerLane; ++k) {
      precise const vec3 g = own[k].p - t.a;
      precise const vec3 size = abs(g);
      precise const float h = t.n.x * g.x + t.n.y * g.y + t.n.z * g.z;
      precise const float e = t.slack.x * size.x + t.slack.y * size.y + t.slack.z * size.z + own[k].slack;
      front_bits[k] |= uint(h > -e) << i;
      back_bits[k] |= uint(h < e) << i;
    }
  }
  for (uint k = 0; k < kPointsPerLane; ++k) {
    const uint point = first + k * kLanes;
    if (point >= push.point_count) continue;
    const uint at = (push.first_word + word) * push.point_count + point;
    front[at] = front_bits[k];
    back[at] = back_bits[k];
    if ((front_bits[k] & back_bits[k]) != 0) {
      const uint slot = atomicAdd(undecided_count, 1);
      if (slot < push.capacity) undecided[slot] = UndecidedWord(at, front_bits[k], back_bits[k]);
    }
  }
}
