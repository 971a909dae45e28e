// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define FITTED_FACES
#include "maps/host/look_up.glsl"

// Returns V: 1 where the light's centre is seen, else 0 (Williams 1978), from maps whose faces are fitted to the view of
// a camera (docs/map-fits.md).
float visibility_of(LightView view, vec3 d, vec3 m) { return light_point_is_seen(view, 0, d, m) ? 1.0 : 0.0; }

#include "maps/host/scalar_main.glsl"
