// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/look_up.glsl"

layout(scalar, binding = 4) readonly buffer Points { vec2 points[]; };

// Returns V (Sen, Cammarano, Hanrahan 2003) from the depth tests of four texels around a receiver. Where these disagree
// an outline passes between them: lines from the cell's point to its neighbours' points divide the cell in four parts,
// one for each texel.

// Returns the silhouette point of a cell, from 0 to 1 across the cell; in the middle if no outline passes through the
// cell.
vec2 point_of(uint map, ivec2 cell) {
  const int count = int(lookup.size) + 1;
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(count)))) return vec2(0.5);
  return points[(int(map) * count + cell.y) * count + cell.x];
}

// Returns whether the texel hides the light's centre from the receiver. Texels outside the map hide nothing.
bool texel_hides(LightView view, MapFace face, ivec2 texel, vec3 d, vec3 m, float along) {
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(lookup.size)))) return false;
  Tap tap = tap_of(view, lookup.size, face, uvec2(texel));
  tap.along = along;
  tap.mirrored = d.z < 0.0 ? -1.0 : 1.0;
  tap.direction.z *= tap.mirrored;
  if (lookup.own_depth != 0) return is_before_depth(tap, along, lookup.bias);
  // The corner may be a texel away, twice the distance of a texel's centre in a hard shadow test.
  return blocks(tap, m, dot(m, d), along * (1.0 + 2.0 * kSteepest * tap.texel), lookup.bias);
}

float across(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

float visibility_of(LightView view, vec3 d, vec3 m) {
  if (!(dot(m, d) > 0.0)) return 0.0;  // the light's centre is below the receiver's horizon
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  if (side.face_count == 0) return 1.0;
  const FaceHit hit = face_hit(view, d);
  const MapFace face = face_of(side, 0, lookup.size, hit.face);
  const vec2 at = (hit.f.xy / hit.f.z - face.lower) / face.texel - 0.5;
  const ivec2 texel = ivec2(floor(at)), cell = texel + 1;
  bool hides[4];
  uint count = 0;
  for (int k = 0; k < 4; ++k) {
    hides[k] = texel_hides(view, face, texel + ivec2(k % 2, k / 2), d, m, hit.f.z);
    count += hides[k] ? 1 : 0;
  }
  if (count == 0) return 1.0;
  if (count == 4) return 0.0;
  const vec2 middle = point_of(face.map, cell), p = at - vec2(texel) - middle;
  const vec2 right = point_of(face.map, cell + ivec2(1, 0)) + vec2(1.0, 0.0) - middle,
             left = point_of(face.map, cell - ivec2(1, 0)) - vec2(1.0, 0.0) - middle,
             above = point_of(face.map, cell + ivec2(0, 1)) + vec2(0.0, 1.0) - middle,
             below = point_of(face.map, cell - ivec2(0, 1)) - vec2(0.0, 1.0) - middle;
  const bool is_above = p.x >= 0.0 ? across(right, p) >= 0.0 : across(p, left) >= 0.0;
  const bool is_right = p.y >= 0.0 ? across(p, above) >= 0.0 : across(below, p) >= 0.0;
  return hides[(is_above ? 2 : 0) + (is_right ? 1 : 0)] ? 0.0 : 1.0;
}

#include "maps/host/scalar_main.glsl"
