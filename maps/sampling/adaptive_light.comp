#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/sampling/adaptive_light.shared.h"
#define OWN_PUSH AdaptivePush
#include "maps/host/look_up.glsl"
#include "maps/sampling/texel.glsl"

// Schwaerzler, section 3.4: the weighted mean of hard shadows from all light points, buffer of maps by buffer of maps.
// Weights are added in the order of points, as the host adds them: what every point sees has exactly V = 1.

layout(scalar, binding = 4) readonly buffer Weights { float weights[]; };  // of all light points

// Percentage-closer filter (Reeves, Salesin and Cook 1987) of the four texels whose centres surround the receiver, weighted
// bilinearly, each compared with the receiver's plane: the lit share.
float filtered(LightView view, uint first_map, vec3 d, vec3 m) {
  const Texel texel = locate(view, first_map, lookup.size, d);
  const float h = dot(m, d);
  float lit[4];
  for (int k = 0; k < 4; ++k) {
    // The receiver's own texel first, then those beyond its nearer borders.
    vec3 to = texel.direction;
    if ((k & 1) != 0) to += sign(texel.off.x) * texel.across[0];
    if ((k & 2) != 0) to += sign(texel.off.y) * texel.across[1];
    const Tap tap = fetch(view, first_map, lookup.size, k == 0 ? d : texel.along * to);
    lit[k] = blocks(tap, m, h, tap.along * (1.0 + kSteepest * tap.texel), lookup.bias) ? 0.0 : 1.0;
  }
  const vec2 part = abs(texel.off);
  const float first_row = lit[0] + part.x * (lit[1] - lit[0]), second_row = lit[2] + part.x * (lit[3] - lit[2]);
  return first_row + part.y * (second_row - first_row);
}

float lit_share(LightView view, uint first_map, vec3 d, vec3 m) {
  if (!on_emitting_side(d)) return 0.0;
  if (own.filter_taps != 0 && dot(m, d) > 0.0) return filtered(view, first_map, d, m);
  return light_point_is_seen(view, first_map, d, m) ? 1.0 : 0.0;
}

void main() {
  const uint i = this_receiver();
  if (i >= lookup.receiver_count) return;
  const uint result = lookup.first_result + i;
  const Receiver receiver = receivers[lookup.first_receiver + i];
  const bool receives = receiver.n != vec3(0.0);
  const vec3 m = -to_basis(lookup.basis, receiver.n);
  float sum = lookup.first_point == 0 ? 0.0 : uintBitsToFloat(results[result]);
  for (uint k = 0; k < lookup.point_count; ++k) {
    float lit = 1.0;
    if (receives) {
      const LightView view = views[lookup.first_point + k];
      lit = lit_share(view, k * lookup.faces, to_basis(lookup.basis, receiver.p - view.point), m);
    }
    sum += weights[lookup.first_point + k] * lit;
  }
  results[result] = floatBitsToUint(own.last != 0 ? min(sum / own.total, 1.0) : sum);
}
