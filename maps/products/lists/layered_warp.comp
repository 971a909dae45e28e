// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/lists/layered_depth.shared.h"

// Warps every texel of one light sample's maps into the maps of the light's centre (Agrawala et al. 2000). A texel
// covers the centre's texels whose centres lie in its image; neighbours on one surface (depths within epsilon plus the
// change expected from the slope on the other side) share the image of their border, so that a surface is covered
// without gaps. The stored depth is that of the plane through the middles of the texel's borders, taken at the centre's
// texel, not at the sample's own texel: otherwise different samples' views of one steep surface would be separate
// surfaces. Contributions to a texel form a list; layered_merge.comp reads the list in the order of depth, so the order
// of writing does not matter.

layout(local_size_x = kLookupGroup) in;
layout(scalar, binding = 0) readonly buffer Centre { LightView centre; };
layout(scalar, binding = 1) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 2) readonly buffer Maps { float maps[]; };
layout(scalar, binding = 3) buffer Heads { uint heads[]; };   // the last node of each texel of the centre, counted from
                                                              // 1
layout(scalar, binding = 4) buffer Nodes { LayerNode nodes[]; };
layout(scalar, binding = 5) buffer NodeCount { uint node_count; };
layout(scalar, binding = 6) readonly buffer Casters { float casters[]; };  // texels of Maps hidden by these are skipped
layout(scalar, push_constant) uniform Push { WarpPush push; };

// Convert to coordinates on face k of a side, and back (face_of in map_fit.cpp).
vec3 on_face(vec3 e, uint k) {
  if (k == 0) return e;
  if (k == 1) return vec3(e.y, e.z, e.x);
  if (k == 2) return vec3(e.y, e.z, -e.x);
  if (k == 3) return vec3(e.x, e.z, e.y);
  return vec3(e.x, e.z, -e.y);
}
vec3 off_face(vec3 f, uint k) {
  if (k == 0) return f;
  if (k == 1) return vec3(f.z, f.x, f.y);
  if (k == 2) return vec3(-f.z, f.x, f.y);
  if (k == 3) return vec3(f.x, f.z, f.y);
  return vec3(f.x, -f.z, f.y);
}

// Limit of a slope, in texels of depth for each texel: as for receivers, taps.glsl.
const float kSteepest = 8.0;

// Plane as seen on a face: 1/depth is affine there. `at`: 1/depth in the middle; `change`: for one texel across and up.
struct Sheet {
  vec2 middle;
  float at;
  vec2 change;
};

// Returns the plane through the images of a texel's middle and of the middles of its borders (x, y in texels, and
// depth): left, right, lower, upper, middle.
Sheet sheet_through(vec3 image[5]) {
  const vec2 first = image[1].xy - image[0].xy, second = image[3].xy - image[2].xy;
  const float rise = 1.0 / image[1].z - 1.0 / image[0].z, climb = 1.0 / image[3].z - 1.0 / image[2].z;
  const float area = first.x * second.y - first.y * second.x;
  Sheet sheet = Sheet(image[4].xy, 1.0 / image[4].z, vec2(0.0));
  // Seen from the side, the plane has no area, and its slope cannot be determined.
  if (abs(area) > 1.0 / 256.0 * length(first) * length(second)) {
    sheet.change = vec2(rise * second.y - climb * first.y, climb * first.x - rise * second.x) / area;
  }
  return sheet;
}

void main() {
  const uint i = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= push.sample_faces * push.size * push.size) return;
  const LightView view = views[push.point];
  const uint first = push.first_map * push.size * push.size;
  const float stored = maps[first + i];
  if (stored >= 1.0 || casters[first + i] < stored) return;
  const float w = stored * view.far;
  const ivec2 at = ivec2(i % push.size, i / push.size % push.size);
  const uint face = i / (push.size * push.size), s = face >= view.side[0].first_face + view.side[0].face_count ? 1 : 0;
  const SideView side = view.side[s], to = centre.side[s];
  const uint own = face - side.first_face;
  const vec2 lower = side.face_count == 1 ? side.lower : vec2(-1.0, own == 0 ? -1.0 : 0.0);
  const vec2 upper = side.face_count == 1 ? side.upper : vec2(1.0), width = (upper - lower) / float(push.size);
  const vec3 offset = view.point - centre.point;
  const vec3 o = vec3(dot(push.basis.u, offset), dot(push.basis.v, offset), (s == 0 ? 1.0 : -1.0) * dot(push.basis.n, offset));

  // The texel's centre, and the middles of its four borders at the depths shared with its neighbours.
  const vec2 middle = lower + (vec2(at) + 0.5) * width, begin = lower + vec2(at) * width, end = lower + vec2(at + 1) * width;
  vec3 places[5];
  places[4] = o + off_face(vec3(middle * w, w), own);
  float beside[4];  // depths of the neighbours; 0: no neighbour
  for (uint k = 0; k < 4; ++k) {
    const ivec2 next = at + ivec2(k == 0 ? -1 : (k == 1 ? 1 : 0), k == 2 ? -1 : (k == 3 ? 1 : 0));
    beside[k] = 0.0;
    if (all(greaterThanEqual(next, ivec2(0))) && all(lessThan(next, ivec2(push.size)))) {
      const float found = maps[first + (face * push.size + uint(next.y)) * push.size + uint(next.x)];
      if (found < 1.0) beside[k] = found * view.far;
    }
  }
  for (uint k = 0; k < 4; ++k) {
    const float opposite = beside[k ^ 1u];
    const float slope = opposite > 0.0 ? min(abs(w - opposite), kSteepest * max(width.x, width.y) * w) : 0.0;
    float border = w;
    if (beside[k] > 0.0 && abs(beside[k] - w) <= push.epsilon * max(beside[k], w) + slope) border = 0.5 * (beside[k] + w);
    const vec2 on = vec2(k == 0 ? begin.x : (k == 1 ? end.x : middle.x), k == 2 ? begin.y : (k == 3 ? end.y : middle.y));
    places[k] = o + off_face(vec3(on * border, border), own);
  }

  for (uint k = 0; k < to.face_count; ++k) {
    const bool window = to.face_count == 1;
    const vec2 low = window ? to.lower : vec2(-1.0, k == 0 ? -1.0 : 0.0), high = window ? to.upper : vec2(1.0);
    const vec2 texel = (high - low) / float(push.size);
    vec2 from = vec2(1e30), until = vec2(-1e30);
    bool in_front = true;
    vec3 image[5];
    float nearest = 1e30, deepest = 0.0;
    for (uint c = 0; c < 5; ++c) {
      const vec3 f = on_face(places[c], k);
      in_front = in_front && f.z > 0.0;
      image[c] = vec3((f.xy / f.z - low) / texel, f.z);
      nearest = min(nearest, f.z);
      deepest = max(deepest, f.z);
      if (c == 4) continue;
      from = min(from, image[c].xy);
      until = max(until, image[c].xy);
    }
    if (!in_front) continue;
    const Sheet sheet = sheet_through(image);
    // Texels whose centres c + 1/2 are in [from, until).
    const ivec2 first_texel = ivec2(ceil(clamp(from - 0.5, vec2(0.0), vec2(push.size))));
    const ivec2 end_texel = ivec2(ceil(clamp(until - 0.5, vec2(0.0), vec2(push.size))));
    for (int y = first_texel.y; y < end_texel.y; ++y) {
      for (int x = first_texel.x; x < end_texel.x; ++x) {
        const uint node = atomicAdd(node_count, 1);
        if (node >= push.node_capacity) continue;
        const uint place = ((to.first_face + k) * push.size + uint(y)) * push.size + uint(x);
        // Clamped to the depths of the texel: surfaces next to the texel are not included.
        const float inverse = sheet.at + dot(sheet.change, vec2(x, y) + 0.5 - sheet.middle);
        const float t = clamp(1.0 / max(inverse, 1.0 / deepest), nearest, deepest);
        // Half a texel across and up is the largest distance of a represented point from the texel's centre.
        const float reach = min(0.5 * t * t * (abs(sheet.change.x) + abs(sheet.change.y)), kSteepest * max(texel.x, texel.y) * t);
        nodes[node] = LayerNode(floatBitsToUint(t), atomicExchange(heads[place], node + 1), reach);
      }
    }
  }
}
