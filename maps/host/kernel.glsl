// SPDX-License-Identifier: Apache-2.0
// Texels of a map from the light's centre that can hide some of the light from a receiver: occluders lie in the pyramid
// of the light over the receiver, and the map sees the part of this pyramid at heights of at least `near` over the
// light's plane in a part of each face. On a window, with tangents (a, b) = (x/z, y/z), this part is Guennebaud 2006's
// kernel |alpha - a| <= half the light (1/near - 1/z).

// Texels first.x ... last.x and first.y ... last.y of a face; empty where last < first.
struct Kernel {
  ivec2 first, last;
  bool whole;  // no part of the kernel is outside the face
};

const Kernel kNoKernel = Kernel(ivec2(0), ivec2(-1), false);

bool is_empty(Kernel kernel) { return any(lessThan(kernel.last, kernel.first)); }

// Returns the kernel of a receiver. e: the receiver in (x, y, |z|); lower, upper: the light's bounding rectangle in its
// plane, around 0; no occluder is nearer to the light's plane than near > 0. `padding`: margin of texels on every side,
// for surfaces between texels' centres.
Kernel kernel_on(MapFace face, uint size, vec3 e, vec2 lower, vec2 upper, float near, int padding) {
  if (!(near < e.z)) return kNoKernel;
  // The pyramid between the receiver and the height `near` is convex, so its corners bound it. On a sideways face, the
  // part less than `near` along the axis is clipped: in the face's directions, no height is above the distance along
  // the axis, so no occluder is in that part.
  const float share = near / e.z;  // fraction of the distance from the light to the receiver
  vec3 corners[5];
  for (int i = 0; i < 4; ++i) {
    const vec2 at = vec2((i & 1) == 0 ? lower.x : upper.x, (i & 2) == 0 ? lower.y : upper.y);
    corners[i] = to_face(face, vec3(e.xy * share + at * (1.0 - share), near));
  }
  corners[4] = to_face(face, e);
  vec2 from = vec2(1e30), to = vec2(-1e30);
  for (int i = 0; i < 5; ++i) {
    if (corners[i].z >= near) {
      from = min(from, corners[i].xy / corners[i].z);
      to = max(to, corners[i].xy / corners[i].z);
    }
    if (face.axis == 2) continue;  // the height is the distance along the axis: nothing is clipped
    for (int j = 0; j < i; ++j) {
      if ((corners[i].z < near) == (corners[j].z < near)) continue;
      const vec2 cut = mix(corners[i].xy, corners[j].xy, (near - corners[i].z) / (corners[j].z - corners[i].z)) / near;
      from = min(from, cut);
      to = max(to, cut);
    }
  }
  // On a sideways face, a row's centre may reach the height `near` even where the row's lower border does not.
  const int more = padding + (face.axis == 2 ? 0 : 1);
  const float end = float(size);
  Kernel kernel;
  kernel.first = ivec2(clamp(floor((from - face.lower) / face.texel), vec2(-end), vec2(2.0 * end))) - more;
  kernel.last = ivec2(clamp(floor((to - face.lower) / face.texel), vec2(-end), vec2(2.0 * end))) + more;
  kernel.whole = all(greaterThanEqual(kernel.first, ivec2(0))) && all(lessThan(kernel.last, ivec2(size)));
  kernel.first = max(kernel.first, ivec2(0));
  kernel.last = min(kernel.last, ivec2(int(size) - 1));
  return is_empty(kernel) ? kNoKernel : kernel;
}

// Returns the intersection of the line from the receiver e through q with the light's plane, as (x, y, w) with the
// point at (x, y) / w: w is the height of the receiver above q over the light's plane.
vec3 onto_light(vec3 e, vec3 q) { return vec3(q.xy * e.z - e.xy * q.z, e.z - q.z); }
