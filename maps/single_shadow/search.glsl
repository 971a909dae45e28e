// SPDX-License-Identifier: Apache-2.0
// Search of the map around a receiver's own texel, nearest texels first. Included after look_up.glsl, with OWN_PUSH
// SearchPush.
#include "maps/host/neighbours.glsl"
#include "maps/single_shadow/falloff.glsl"
#define PYRAMID_BINDING 6
#include "maps/products/depth_pyramid.glsl"

layout(scalar, binding = 4) readonly buffer Nearest { float nearest[2]; };
layout(scalar, binding = 5) readonly buffer Offsets { ivec2 offsets[]; };  // sorted by length
layout(scalar, binding = 7) buffer Counts { uint cut_searches[2]; };       // a count of 64 bits, of which the lower 32
                                                                           // are sufficient

struct Search {
  LightView view;
  FaceHit hit;
  Tap tap;             // the receiver's own texel
  vec2 step, at;       // a texel's extent; the receiver on the face, in texels
  vec2 seen;           // the receiver, in (x/z, y/z)
  vec3 m;
  float h, height;
  float smallest_step;
  float near;          // smallest distance from the light's plane of a surface that can shade the receiver
  bool free;           // no surface within the search's radius can shade the receiver
};

Search begin_search(LightView view, vec3 d, vec3 m) {
  Search search;
  search.view = view;
  search.hit = face_hit(view, d);
  search.tap = fetch(view, 0, lookup.size, d);
  search.step = (search.hit.upper - search.hit.lower) / float(lookup.size);
  search.at = (search.hit.f.xy / search.hit.f.z - search.hit.lower) / search.step;
  search.seen = d.xy / abs(d.z);
  search.m = m;
  search.h = dot(m, d);
  search.height = abs(d.z);
  search.smallest_step = min(search.step.x, search.step.y);
  const uint side = d.z < 0.0 ? 1 : 0;
  search.near = nearest[side];
  search.free = search.near >= search.height;
  // Within one face the pyramid gives tighter bounds.
  const ivec2 cell = ivec2(floor(search.at)), first = cell - int(own.radius), last = cell + int(own.radius);
  const bool window = view.side[side].face_count == 1;
  if (!window || search.free) return search;
  const ivec2 most = ivec2(int(lookup.size) - 1);
  const vec2 range = depth_range(view.side[side].first_face, uvec2(clamp(first, ivec2(0), most)), uvec2(clamp(last, ivec2(0), most)));
  // Largest depth of the receiver's plane within the radius, as in texel_blocks (neighbours.glsl).
  const float deepest = search.tap.along * (1.0 + kSteepest * search.tap.texel * float(own.radius + 1));
  search.near = max(search.near, range.x * view.far);
  search.free = search.free || search.near >= deepest;
  return search;
}

// Returns the texel of an offset in `tap`; false if there is none, which counts as not shading.
bool search_texel(Search search, ivec2 offset, out Tap tap) {
  const vec3 direction = neighbour(search.tap, search.step, vec2(offset));
  tap = search.tap;
  if (!(direction.z * search.tap.mirrored > 0.0)) return false;
  tap = fetch(search.view, 0, lookup.size, direction * search.tap.along);
  return true;
}

bool search_blocks(Search search, Tap tap, ivec2 offset) {
  const float away = max(abs(float(offset.x)), abs(float(offset.y)));
  return texel_blocks(tap, search.m, search.h, tap.along, away);
}

// Returns the distance of a texel from the receiver, as seen from the light's centre, in (x/z, y/z): to the texel's
// border, half a texel nearer than its centre.
float distance_to(Search search, Tap tap) {
  const float half_texel = search.tap.axis == 2 && tap.axis == 2 ? 0.5 * max(search.step.x, search.step.y) : 0.0;
  return max(distance(search.seen, tap.direction.xy / abs(tap.direction.z)) - half_texel, 0.0);
}

// Returns whether all texels from this offset on are farther away than `most`. (On a sideways face, distances on the
// face are not distances in (x/z, y/z).)
bool is_beyond(Search search, ivec2 offset, float most) {
  return search.tap.axis == 2 && (length(vec2(offset)) - 2.0) * search.smallest_step > most;
}

// Counts a search that went through all offsets and may have found more up to the distance `most`. Distances are known
// only on the face along the light's axis.
void count_cut(Search search, uint asked, float most) {
  const bool ended = search.tap.axis != 2 || (float(own.radius) - 1.0) * search.smallest_step > most;
  if (asked == own.offsets && !ended) atomicAdd(cut_searches[0], 1);
}

// Returns the width of the outer or inner half of a penumbra that an occluder at height `z` casts on the receiver: a D
// / A of Parker et al., as seen from the light's centre.
float half_penumbra(Search search, float z) { return own.light * (1.0 / z - 1.0 / search.height); }
