#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/accumulate.shared.h"

// Heckbert and Herf 1997: the mean of hard shadows, kept apart as bits. One invocation asks up to 32 maps for one
// receiver. Batches of maps come in the order of light samples; the first batch of a word writes it, later ones add.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Receivers { Receiver receivers[]; };
layout(scalar, binding = 1) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 2) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 3) buffer Masks { uint masks[]; };
layout(scalar, push_constant) uniform Push { AccumulatePush push; };

#include "maps/lookup.glsl"

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.lookup.receiver_count) return;
  const Receiver receiver = receivers[push.lookup.first_receiver + i];
  const bool receives = receiver.n != vec3(0.0);
  const vec3 m = -to_frame(push.lookup.frame, receiver.n);
  const uint first_bit = push.first_sample & 31;

  uint visible = 0;
  for (uint k = 0; k < push.sample_count; ++k) {
    bool lit = true;
    if (receives) {
      const LightView view = views[push.first_sample + k];
      const vec3 d = to_frame(push.lookup.frame, receiver.p - view.point);
      const bool in_front = d.z > 0.0 || (push.lookup.two_sided != 0 && d.z < 0.0);
      lit = in_front && dot(m, d) > 0.0 && !hard_shadow(view, k * push.faces, push.lookup.size, d, m, push.lookup.bias);
    }
    visible |= lit ? 1u << (first_bit + k) : 0u;
  }
  const uint word = (push.lookup.first_result + i) * push.words_per_mask + push.first_sample / 32;
  masks[word] = first_bit == 0 ? visible : masks[word] | visible;
}
