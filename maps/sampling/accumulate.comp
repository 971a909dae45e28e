// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/look_up.glsl"

// Returns one bit for each light sample: the hard shadow of that sample (Heckbert and Herf 1997: V is the mean of hard
// shadows).
bool sees(LightView view, uint first_map, vec3 d, vec3 m) { return light_point_is_seen(view, first_map, d, m); }

#include "maps/host/mask_main.glsl"
