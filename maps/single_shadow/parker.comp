// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/single_shadow/search.shared.h"
#define OWN_PUSH SearchPush
#include "maps/host/look_up.glsl"
#include "maps/single_shadow/search.glsl"

// Returns V for objects with soft edges (Parker et al. 1998): 0 in the hard shadow; else the least, over all texels, of
// s(x / b). x is the distance of the texel's surface from the ray to the light's centre, and b = a D / A the width of its
// soft edge, with a the light's radius, D the distance from the receiver to the surface and A that to the light. s is
// the falloff (docs/parker.md).

float visibility_of(LightView view, vec3 d, vec3 m) {
  if (!(dot(m, d) > 0.0)) return 0.0;  // the light's centre is below the receiver's horizon
  const Search search = begin_search(view, d, m);
  if (search_blocks(search, search.tap, ivec2(0))) return 0.0;
  if (search.free) return 1.0;
  const float most = half_penumbra(search, search.near);
  float least = 1.0;
  uint k = 0;
  for (; k < own.offsets; ++k) {
    const ivec2 offset = offsets[k];
    if (is_beyond(search, offset, least * most)) break;
    Tap tap;
    if (!search_texel(search, offset, tap) || !search_blocks(search, tap, offset)) continue;
    const float width = half_penumbra(search, tap.depth * abs(tap.direction.z));
    if (width > 0.0) least = min(least, distance_to(search, tap) / width);
  }
  count_cut(search, k, least * most);
  return light_at(own.falloff, least);
}

#include "maps/host/scalar_main.glsl"
