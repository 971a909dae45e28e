#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/map_view.shared.h"

// Williams 1978: V is 1 where the light's centre is seen, else 0.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Receivers { Receiver receivers[]; };
layout(scalar, binding = 1) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 2) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 3) writeonly buffer Visibility { float visibility[]; };
layout(scalar, push_constant) uniform Push { LookupPush push; };

#include "maps/lookup.glsl"

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.receiver_count) return;
  const Receiver receiver = receivers[push.first_receiver + i];
  float v = 1.0;
  if (receiver.n != vec3(0.0)) {
    const LightView view = views[0];
    const vec3 d = to_frame(push.frame, receiver.p - view.point);
    const vec3 m = -to_frame(push.frame, receiver.n);
    const bool in_front = d.z > 0.0 || (push.two_sided != 0 && d.z < 0.0);
    const bool lit = in_front && dot(m, d) > 0.0 && !hard_shadow(view, 0, push.size, d, m, push.bias);
    v = lit ? 1.0 : 0.0;
  }
  visibility[push.first_result + i] = v;
}
