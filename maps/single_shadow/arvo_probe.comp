// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/look_up.glsl"

// Returns the input of arvo.cpp's flood: 1 where the light's centre is seen, 0 below the horizon; in the hard shadow,
// the height of the shadow's caster over the light's plane, with a minus sign.
float visibility_of(LightView view, vec3 d, vec3 m) {
  if (!(dot(m, d) > 0.0)) return 0.0;
  if (!hard_shadow(view, 0, lookup.size, d, m, lookup.bias)) return 1.0;
  const Tap tap = fetch(view, 0, lookup.size, d);
  return -tap.depth * abs(tap.direction.z);
}

#include "maps/host/scalar_main.glsl"
