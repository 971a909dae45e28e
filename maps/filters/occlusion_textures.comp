// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/filters/occlusion_textures.shared.h"
#define OWN_PUSH OcclusionPush
#include "maps/host/look_up.glsl"
#define PREFILTER_FIRST 7
#include "maps/products/prefilter.glsl"
#include "maps/products/slices.shared.h"

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };
layout(scalar, binding = 5) readonly buffer Frame { MapFrame frame; };
layout(scalar, binding = 6) readonly buffer Planes { SlicePlanes planes; };
layout(scalar, binding = 12) readonly buffer Pattern { vec2 pattern[]; };  // light points in the light's basis
#include "maps/filters/horizon.glsl"

// Returns V (Eisemann and Décoret 2006; Eisemann et al. 2009, section 5.2.5): each slice hides the fraction of the
// light that a box filter finds in the slice, with the light seen through the slice's plane (Soler and Sillion 1998);
// the visible fractions of the slices are multiplied.
float visibility_of(LightView view, vec3 d, vec3 m) {
  const uint s = d.z < 0.0 ? 1 : 0;
  const float horizon = share_above_horizon(d, m, own.horizon_samples);
  const float height = height_less_bias(view, d, m);
  if (!(nearest[s] < height)) return horizon;
  const float smallest = view.far / 1048576.0;  // smallest depth of maps: a window must be finite
  float v = 1.0;
  for (uint k = 0; k < planes.count && v > 0.0; ++k) {
    const float plane = planes.plane[s][k];
    // A slice that ends below the receiver is skipped: next to the receiver, it also holds surfaces above or below it.
    if (!(plane < height)) break;
    const Box box = box_through(view, d, frame.half_box, max(plane, smallest));
    v *= 1.0 - mean_over(k, box, 0.0);
  }
  return min(clamp(v, 0.0, 1.0), horizon);
}

#include "maps/host/scalar_main.glsl"
