// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/single_shadow/outer_map.shared.h"
#include "render/both.glsl"

// Computes the position of a texel's centre in the penumbra beside an edge; the rasteriser only selects the texels.
// From each point of the silhouette a line leads outward: in (x/z, y/z) always along `outward`, or around an end in all
// directions.
//
// Wyman and Hansen 2003: at depth Z a cone's line is at the distance r (1/Z_v - 1/Z) from its vertex at depth Z_v. With
// Z_F the depth of the cone at the texel and Z_P that of the surface seen from the light there, V is 3 c^2 - 2 c^3 with
// c = (Z_F - Z_v) / (Z_P - Z_v); the map stores c, and the look-up computes the rest. Chan and Durand 2003: alpha =
// (distance) / width; the map stores alpha / (1 - Z_v/Z_P).

STORAGE(1) readonly buffer Surfaces { float surfaces[]; };
STORAGE(2) buffer Outer { uint outer[]; };  // for each texel: the least stored value, and the depth of the nearest edge
PUSH_CONSTANTS OuterBlock { OuterPush push; };  // not Push: blocks with one name are one block in both stages
layout(location = 0) flat in uint edge_drawn;
layout(location = 1) flat in uint part_drawn;

vec2 pair_at(uint i) { return vec2(corner_at(i / 3)[i % 3], corner_at((i + 1) / 3)[(i + 1) % 3]); }
vec3 triple_at(uint i) { return vec3(pair_at(i), corner_at((i + 2) / 3)[(i + 2) % 3]); }

void main() {
  const uint at = edge_drawn * kOuterFloats;
  const vec3 a = triple_at(at), b = triple_at(at + 3);
  const uvec2 cell = uvec2(gl_FragCoord.xy);
  const vec2 abw = push.lower + (vec2(cell) + 0.5) * push.texel;
  vec2 seen = abw;     // the texel as (x/z, y/z)
  float height = 1.0;  // z of the texel's direction, of length one along the face's axis
  if (push.axis != 2) {
    height = abw.y;
    seen = (push.axis == 0 ? vec2(push.sign, abw.x) : vec2(abw.x, push.sign)) / height;
  }
  const vec2 first = a.xy / a.z, second = b.xy / b.z;
  float beside, inverse;  // distance of the texel beside the silhouette, and 1 / Z_v there
  if (part_drawn == kSheet) {
    const vec2 outward = pair_at(at + 6), direction = second - first, to = seen - first;
    const float across = direction.x * outward.y - direction.y * outward.x;
    const float share = (to.x * outward.y - to.y * outward.x) / across;
    if (!(share >= 0.0 && share <= 1.0)) discard;
    beside = (direction.x * to.y - direction.y * to.x) / across;
    inverse = mix(1.0 / a.z, 1.0 / b.z, share);
  } else {
    beside = distance(seen, part_drawn == kFirstEnd ? first : second);
    inverse = 1.0 / (part_drawn == kFirstEnd ? a.z : b.z);
  }
  const uint texel = push.first + cell.y * push.size + cell.x;
  if (surfaces[texel] >= 1.0) discard;  // there is no surface to be lit
  const float surface = surfaces[texel] * push.far * height;
  float kept;
  if (push.smoothies != 0) {
    const float ratio = 1.0 - 1.0 / (inverse * surface);
    if (!(ratio > 0.0) || !(beside <= push.width)) discard;
    kept = beside / (push.width * ratio);
  } else {
    const float cone = inverse - beside / push.width;  // 1 / Z_F
    if (!(cone * surface > 1.0)) discard;
    kept = (1.0 / cone - 1.0 / inverse) / (surface - 1.0 / inverse);
  }
  // Most values are not the least: a comparison without an atomic operation is sufficient for these.
  const uint least = floatBitsToUint(clamp(kept, 0.0, 1.0)), near = floatBitsToUint(1.0 / inverse);
  if (least < outer[2 * texel]) atomicMin(outer[2 * texel], least);
  if (near < outer[2 * texel + 1]) atomicMin(outer[2 * texel + 1], near);
}
