// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/sampling/adaptive_light.shared.h"
#define OWN_PUSH AdaptivePush
#include "maps/host/look_up.glsl"
#include "maps/sampling/texel.glsl"

// Computes the weighted mean of hard shadows from all light points, buffer of maps by buffer of maps (Schwaerzler,
// section 3.4). Weights are added in the order of points, as on the host: a receiver seen from every point has exactly
// V = 1.

layout(scalar, binding = 4) readonly buffer Weights { float weights[]; };  // of all light points

// Returns the lit fraction from a percentage-closer filter (Reeves, Salesin and Cook 1987) of the four texels whose
// centres surround the receiver, weighted bilinearly, each compared with the receiver's plane.
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

// Returns the lit fraction from a wider filter: a square `taps` - 1 texels wide around the receiver, with each texel
// weighted by its overlap (for a square one texel wide, the bilinear weight). Texels farther away than the receiver's
// own may lie farther along its plane.
float widely_filtered(LightView view, uint first_map, vec3 d, vec3 m) {
  const Texel texel = locate(view, first_map, lookup.size, d);
  const float h = dot(m, d), half_width = 0.5 * float(own.taps - 1);
  const int reach = int(ceil(half_width));
  const float side = d.z < 0.0 ? -1.0 : 1.0;
  float lit = 0.0, dark = 0.0;
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      const vec2 from = max(vec2(i, j) - 0.5, texel.off - half_width), to = min(vec2(i, j) + 0.5, texel.off + half_width);
      const vec2 overlap = max(to - from, vec2(0.0));
      if (overlap.x * overlap.y == 0.0) continue;
      const vec3 direction = texel.direction + float(i) * texel.across[0] + float(j) * texel.across[1];
      bool blocked = false;
      if (direction.z * side > 0.0) {  // behind the light's plane there is no occluder
        const Tap tap = fetch(view, first_map, lookup.size, texel.along * direction);
        const float away = float(max(max(abs(i), abs(j)), 1));
        blocked = blocks(tap, m, h, tap.along * (1.0 + kSteepest * tap.texel * away), lookup.bias);
      }
      if (blocked) {
        dark += overlap.x * overlap.y;
      } else {
        lit += overlap.x * overlap.y;
      }
    }
  }
  return lit / (lit + dark);
}

float lit_share(LightView view, uint first_map, vec3 d, vec3 m) {
  if (!on_emitting_side(d)) return 0.0;
  if (own.taps == 2 && dot(m, d) > 0.0) return filtered(view, first_map, d, m);
  if (own.taps > 2 && dot(m, d) > 0.0) return widely_filtered(view, first_map, d, m);
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
