// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/nearest_ids.shared.h"
#include "maps/single_shadow/search.shared.h"
#define OWN_PUSH SearchPush
#include "maps/host/look_up.glsl"
#include "maps/single_shadow/search.glsl"

// Returns V (Brabec and Seidel 2002): a lit receiver searches for the nearest texel that would shade it, a shaded one
// for the nearest that would not. V is 1/2 on the border between these, and rises or falls from there over the half
// penumbra of the occluder.

layout(scalar, binding = 8) readonly buffer Ids { uint ids[]; };
layout(scalar, binding = 9) readonly buffer Objects { uint object_of[]; };

bool shades(Search search, Tap tap, ivec2 offset) {
  if (!search_blocks(search, tap, offset)) return false;
  if (own.ids == 0 || tap.depth >= tap.far) return true;
  const uint id = ids[tap.number];
  return id == kNoId || object_of[id] != receiver_object;
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  if (!(dot(m, d) > 0.0)) return 0.0;  // the light's centre is below the receiver's horizon
  const Search search = begin_search(view, d, m);
  const bool shaded = shades(search, search.tap, ivec2(0));
  if (!shaded && search.free) return 1.0;
  // The occluder of a shaded receiver is known, and thus the inner extent of its penumbra.
  const float inner = half_penumbra(search, search.tap.depth * abs(search.tap.direction.z));
  const float most = shaded ? inner : half_penumbra(search, search.near);
  float best = 1e30, width = inner;
  uint k = 0;
  for (; k < own.offsets; ++k) {
    const ivec2 offset = offsets[k];
    if (is_beyond(search, offset, min(best, most))) break;
    Tap tap;
    // An offset may lead behind the light's plane, where there is no texel.
    if (!search_texel(search, offset, tap) || shades(search, tap, offset) == shaded) continue;
    const float away = distance_to(search, tap);
    if (!(away < best)) continue;
    best = away;
    if (!shaded) width = half_penumbra(search, tap.depth * abs(tap.direction.z));
  }
  count_cut(search, k, min(best, most));
  if (best == 1e30 || !(width > 0.0)) return shaded ? 0.0 : 1.0;
  const float share = min(best / width, 1.0);
  return light_at(own.falloff, shaded ? 0.5 - 0.5 * share : 0.5 + 0.5 * share);
}

#include "maps/host/scalar_main.glsl"
