// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/single_shadow/kirsch_doellner.shared.h"
#define OWN_PUSH KirschDoellnerPush
#include "maps/host/look_up.glsl"
#include "maps/single_shadow/falloff.glsl"

// Returns V (Kirsch and Doellner 2003): 1 outside of the hard shadow. Inside, V falls with the distance of the border
// in the shadow width map, down to 0 where a light of this radius behind the occluder is hidden.

layout(scalar, binding = 4) readonly buffer Widths { float widths[]; };

const float kFarInside = 1e20;  // larger widths: WidthMap has no distance there

// Returns the distance of the receiver from the border, interpolated between the four nearest texels. Half a texel is
// subtracted: WidthMap measures to the centre of a white texel, which is half a texel behind the border.
float width_at(MapFace face, vec2 at) {
  const vec2 most = vec2(float(lookup.size - 1)), first = floor(at - 0.5), share = at - 0.5 - first;
  float width = 0.0;
  for (int k = 0; k < 4; ++k) {
    const vec2 step = vec2(k & 1, k >> 1), weight = mix(1.0 - share, share, step);
    const uvec2 cell = uvec2(clamp(first + step, vec2(0.0), most));
    const float found = widths[(face.map * lookup.size + cell.y) * lookup.size + cell.x];
    if (found > kFarInside) return found;
    width += weight.x * weight.y * found;
  }
  return max(width - 0.5 * max(face.texel.x, face.texel.y), 0.0);
}

float visibility_of(LightView view, vec3 d, vec3 m) {
  if (!(dot(m, d) > 0.0)) return 0.0;  // the light's centre is below the receiver's horizon
  if (!hard_shadow(view, 0, lookup.size, d, m, lookup.bias)) return 1.0;
  const Tap tap = fetch(view, 0, lookup.size, d);
  // A texel without an occluder is in the ground's own shadow, or in a shadow missing in the width map.
  if (widths[tap.number] == 0.0) return 0.0;
  const FaceHit hit = face_hit(view, d);
  const MapFace face = face_of(view.side[d.z < 0.0 ? 1 : 0], 0, lookup.size, hit.face);
  const float inside = width_at(face, (hit.f.xy / hit.f.z - face.lower) / face.texel);
  const float reach = own.light * (1.0 / (tap.depth * abs(tap.direction.z)) - 1.0 / abs(d.z));
  return reach > 0.0 ? light_at(own.falloff, 1.0 - inside / reach) : 0.0;
}

#include "maps/host/scalar_main.glsl"
