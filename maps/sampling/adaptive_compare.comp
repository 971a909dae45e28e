// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/sampling/adaptive_light.shared.h"
#define OWN_PUSH AdaptiveComparePush
#include "maps/host/look_up.glsl"
#include "maps/sampling/texel.glsl"

// Counts the receivers in whose direction two light points' maps hold surfaces at different heights (Schwaerzler,
// equations 3 and 7). Heights are over the light's plane, the same for all of its points: so two maps of the same
// surface agree. Receivers below the horizon of both points are skipped: their shadow cannot differ.

layout(scalar, binding = 4) readonly buffer MapsB { float maps_b[]; };

shared uint differing;

// Returns the height of the map's surface; 0 for an empty texel.
float height_of(Texel texel, float depth, float far) { return depth < 1.0 ? depth * far * abs(texel.direction.z) : 0.0; }

bool differs(Receiver receiver) {
  if (receiver.n == vec3(0.0)) return false;
  const LightView view_a = views[own.view_a], view_b = views[own.view_b];
  const vec3 m = -to_basis(lookup.basis, receiver.n);
  const vec3 d_a = to_basis(lookup.basis, receiver.p - view_a.point), d_b = to_basis(lookup.basis, receiver.p - view_b.point);
  if (!on_emitting_side(d_a) || !on_emitting_side(d_b)) return false;
  if (dot(m, d_a) <= 0.0 && dot(m, d_b) <= 0.0) return false;
  const Texel at_a = locate(view_a, own.map_a, lookup.size, d_a), at_b = locate(view_b, own.map_b, lookup.size, d_b);
  const float a = at_a.index == kNoTexel ? 0.0 : height_of(at_a, maps[at_a.index], view_a.far);
  const float b = at_b.index == kNoTexel ? 0.0 : height_of(at_b, maps_b[at_b.index], view_b.far);
  if (a == 0.0 || b == 0.0) return a != b;
  if (own.of_range != 0) return abs(a - b) >= own.gamma * max(view_a.far, view_b.far);
  return abs(1.0 - a / b) >= own.gamma;
}

void main() {
  if (gl_LocalInvocationIndex == 0) differing = 0;
  barrier();
  const uint i = this_receiver();
  if (i < lookup.receiver_count && differs(receivers[lookup.first_receiver + i])) atomicAdd(differing, 1);
  barrier();
  if (gl_LocalInvocationIndex == 0 && differing != 0) atomicAdd(results[own.counter], differing);
}
