// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/nearest_ids.shared.h"
#include "maps/host/look_up.glsl"

layout(scalar, binding = 4) readonly buffer Ids { uint ids[]; };
layout(scalar, binding = 5) readonly buffer Numbers { uint number_of[]; };  // number of the plane, or of the object
layout(constant_id = 0) const uint kByObject = 0;

// Hourcade and Nicolas 1985: a surface is lit if the map has the surface's number, whatever the depth. Here numbers are
// those of planes, so that the triangles of one polygon share a number, or those of objects. Surfaces that cast no
// shadow are in no map: their depth is compared instead.
float visibility_of(LightView view, vec3 d, vec3 m) {
  if (receiver_plane == kNoId) return light_point_is_seen(view, 0, d, m) ? 1.0 : 0.0;
  if (!(dot(m, d) > 0.0)) return 0.0;
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  const FaceHit hit = face_hit(view, d);
  const MapFace face = face_of(side, 0, lookup.size, hit.face);
  const vec2 cell = floor((hit.f.xy / hit.f.z - face.lower) / face.texel);
  const uvec2 at = uvec2(clamp(cell, vec2(0.0), vec2(float(lookup.size - 1))));
  const uint id = ids[(face.map * lookup.size + at.y) * lookup.size + at.x];
  return id == kNoId || number_of[id] == (kByObject != 0 ? receiver_object : receiver_plane) ? 1.0 : 0.0;
}

#include "maps/host/scalar_main.glsl"
