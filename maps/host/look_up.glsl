// SPDX-License-Identifier: Apache-2.0
// Common head of all look-up shaders: bindings, and taps into the maps. A shader with its own push constants defines
// OWN_PUSH, the struct's name, before including this file. Products are the shader's own bindings, from FIRST_PRODUCT
// on. The shader then defines one function and includes the main that calls this function:
//   scalar_main.glsl   float visibility_of(LightView view, vec3 d, vec3 m)
//   mask_main.glsl     bool sees(LightView view, uint first_map, vec3 d, vec3 m)
// d: the receiver from the light point, m: its normal away from the light, both in the light's basis. The receiver is
// on an emitting side. If many texels are processed for one receiver by a workgroup, the shader defines
// GROUP_A_RECEIVER before including this file: group_scalar_main.glsl and group_mask_main.glsl list their requirements.
// If a workgroup processes a packet of pixels, the shader defines GROUP_A_PACKET, and has its own main. Either defines
// LISTED_GROUPS if it has a sorting pass (group_list.glsl).
#include "maps/host/map_view.shared.h"

#ifdef SORTS_OUT
layout(local_size_x = kLookupGroup) in;
#elif defined(GROUP_A_PACKET)
layout(local_size_x_id = 0) in;  // a subgroup
#elif defined(GROUP_A_RECEIVER)
layout(local_size_x = 64) in;  // several subgroups, each with as many iterations of loops as a driver permits
#else
layout(local_size_x = kLookupGroup) in;
#endif
layout(scalar, binding = 0) readonly buffer Receivers { Receiver receivers[]; };
layout(scalar, binding = 1) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 2) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 3) buffer Results { uint results[]; };  // masks, or the bits of V
#ifdef FITTED_FACES
#define FIRST_PRODUCT 5  // fitted.glsl uses the previous binding
#else
#define FIRST_PRODUCT 4
#endif
layout(scalar, push_constant) uniform Push {
  LookupPush lookup;
#ifdef OWN_PUSH
  OWN_PUSH own;
#endif
};

#include "maps/host/taps.glsl"
#include "render/group_order.glsl"

uint receiver_plane, receiver_object;  // of the receiver, set by scalar_main.glsl as in Receiver

#ifdef LISTED_GROUPS
#include "maps/host/group_list.glsl"
#else
uint this_group() { return group_in_turn(); }
#endif

// Returns the index of the receiver of this invocation, or of this workgroup, relative to the part's first receiver.
uint this_receiver() {
#ifdef GROUP_A_RECEIVER
  return this_group();
#else
  return this_group() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
#endif
}

bool on_emitting_side(vec3 d) { return d.z > 0.0 || (lookup.two_sided != 0 && d.z < 0.0) || lookup.two_sided == 2; }

// Returns whether the light point is seen (Williams 1978); false if it is below the receiver's own horizon.
bool light_point_is_seen(LightView view, uint first_map, vec3 d, vec3 m) {
  return dot(m, d) > 0.0 && !hard_shadow(view, first_map, lookup.size, d, m, lookup.bias);
}
