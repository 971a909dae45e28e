#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/pcss.shared.h"

// Percentage-closer soft shadows (Fernando 2005), in the light's frame: centre at 0, scene at z > 0. The ray from a
// receiver p to the light point s passes height z at p z/p.z + s (1 - z/p.z): on the map (x/z, y/z), the light as seen
// through height z is an image of the light's own shape, scaled by 1/z - 1/p.z, around the receiver. So both windows have
// the light's shape, and Fernando's width of the penumbra over the receiver, w (p.z - z)/z, is the same thing.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Receivers { Receiver receivers[]; };
layout(scalar, binding = 1) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 2) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 3) readonly buffer Nearest { float nearest[2]; };
layout(scalar, binding = 4) readonly buffer Pattern { vec2 pattern[]; };  // light points in its frame
layout(scalar, binding = 5) writeonly buffer Visibility { float visibility[]; };
layout(scalar, push_constant) uniform Push { PcssPush push; };

#include "maps/lookup.glsl"

// The map at the light point s seen through height z; see above.
Tap tap_at(LightView view, vec3 d, vec2 s, float z) {
  const float height = abs(d.z);
  const vec2 at = d.xy / height + s * (1.0 / z - 1.0 / height);
  return fetch(view, 0, push.lookup.size, vec3(at * height, d.z));
}

// Something is between receiver and light only if it is nearer to the light's plane than the receiver.
bool tap_blocks(Tap tap, vec3 d, vec3 m) {
  const float limit = d.z / tap.direction.z;
  const float h = dot(m, d);
  // Where the light's centre is below the receiver's horizon its plane says nothing about the centre's map.
  if (h <= 0.0) return tap.depth < limit - push.lookup.bias * tap.texel * tap.along;
  return blocks(tap, m, h, limit, push.lookup.bias);
}

float soft_shadow(LightView view, vec3 d, vec3 m) {
  const float height = abs(d.z);

  // 1. Blockers in the light–receiver pyramid where it passes the near plane.
  const float near = min(max(nearest[d.z < 0.0 ? 1 : 0], push.smallest_near), height);
  float sum = 0.0;
  uint blockers = 0;
  for (uint k = 0; k < push.blocker_samples; ++k) {
    const Tap tap = tap_at(view, d, pattern[k], near);
    if (tap_blocks(tap, d, m)) {
      sum += tap.depth * abs(tap.direction.z);
      ++blockers;
    }
  }

  // 2, 3. As if all blockers were one plane at their mean height: share of the light seen past it. A light point that is
  // below the receiver's horizon is hidden whatever the map says.
  const float blocker = blockers == 0 ? height : sum / float(blockers);
  uint visible = 0;
  for (uint k = 0; k < push.filter_samples; ++k) {
    const vec2 s = pattern[push.blocker_samples + k];
    const bool above = dot(m, d - vec3(s, 0.0)) > 0.0;
    if (above && (blockers == 0 || !tap_blocks(tap_at(view, d, s, blocker), d, m))) ++visible;
  }
  return float(visible) / float(push.filter_samples);
}

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.lookup.receiver_count) return;
  const Receiver receiver = receivers[push.lookup.first_receiver + i];
  float v = 1.0;
  if (receiver.n != vec3(0.0)) {
    const LightView view = views[0];
    const vec3 d = to_frame(push.lookup.frame, receiver.p - view.point);
    const bool in_front = d.z > 0.0 || (push.lookup.two_sided != 0 && d.z < 0.0);
    v = in_front ? soft_shadow(view, d, -to_frame(push.lookup.frame, receiver.n)) : 0.0;
  }
  visibility[push.lookup.first_result + i] = v;
}
