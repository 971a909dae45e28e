// SPDX-License-Identifier: Apache-2.0
// Search for a receiver's kernel (Guennebaud, Barthe and Paulin 2006): the kernel's nearest depth gives a narrower
// kernel, with a nearest depth of its own, until the kernel no longer changes. If even the kernel's deepest texel is in
// front of the receiver, all of the light is hidden. Included after group_kernel.glsl, with PYRAMID_BINDING.
#include "maps/backprojection/thresholds.glsl"
#include "maps/products/depth_pyramid.glsl"

const int kSearchRounds = 4;
// Least distance of a projected point below the receiver, as a fraction of the receiver's height; points with a smaller
// distance are projected with this one. A quotient by this fraction is at most a thousand, with an error of 2^-24 of
// that.
const float kLeastRise = 1e-3;

// Returns whether the receiver is behind all surfaces in a kernel's texels. Uses bounds for blocks_light over the
// kernel: the depth h / (m . c) of the receiver's plane is least where m . c is largest, at a corner; the bias has its
// own bound.
bool behind_all(MapFace face, Kernel kernel, float deepest) {
  const vec2 lower = face.lower + (vec2(kernel.first) + 0.5) * face.texel;
  const vec2 upper = face.lower + (vec2(kernel.last) + 0.5) * face.texel;
  const vec3 m = asked.m;
  const float facing = m.z + max(m.x * lower.x, m.x * upper.x) + max(m.y * lower.y, m.y * upper.y);
  const float least_facing = m.z + min(m.x * lower.x, m.x * upper.x) + min(m.y * lower.y, m.y * upper.y);
  const float h = dot(m, asked.e);
  float limit = asked.e.z, slope = 0.0;
  if (lookup.own_depth == 0) {
    if (h <= 0.0) return false;  // a surface in front may be below the receiver's plane (above_plane)
    if (h < limit * facing) limit = h / facing;
    const float across = abs(m.x) + abs(m.y);
    slope = across < kSteepest * least_facing ? across / least_facing : kSteepest;
  }
  return deepest < limit - lookup.bias * max(face.texel.x, face.texel.y) * asked.e.z * (1.0 + slope);
}

// Returns the narrowed kernel. `near`: the nearest depth of the whole map, on return that of the kernel; `lower`,
// `upper`, `padding`: as for kernel_on. `begins`: fraction of a texel's height down to which its occluder extends; 1 if
// the whole occluder is at this height. `umbra`: whether a kernel that hides all of the light ends the search.
// `beside`: a texel takes the depths of texels up to `beside` to its lower left, even if these are outside the kernel:
// a narrower kernel has to allow for them.
Kernel search_kernel(MapFace face, vec2 lower, vec2 upper, inout float near, float begins, int padding, bool umbra, int beside) {
  Kernel kernel = kernel_on(face, lookup.size, asked.e, lower, upper, begins * near, padding);
  for (int round = 0; round < kSearchRounds && !is_empty(kernel); ++round) {
    const vec2 range = depth_range(face.map, uvec2(kernel.first), uvec2(kernel.last));
    if (range.x >= 1.0) return kNoKernel;
    const ivec2 first = max(kernel.first - beside, ivec2(0));
    const float depth = asked.view.far * (beside > 0 ? depth_range(face.map, uvec2(first), uvec2(kernel.last)).x : range.x);
    // On a sideways face, the height over the light's plane of a texel of row b is b times its depth.
    const float height = face.axis == 2 ? depth : depth * (float(first.y) + 0.5) * face.texel.y;
    if (umbra && face.axis == 2 && asked.side.face_count == 1 && kernel.whole && lookup.depth_use == kDepthFirst &&
        behind_all(face, kernel, range.y * asked.view.far)) {
      all_hidden = true;
      return kNoKernel;
    }
    if (height <= near) break;
    near = height;
    const Kernel narrower = kernel_on(face, lookup.size, asked.e, lower, upper, begins * near, padding);
    const bool same = narrower.first == kernel.first && narrower.last == kernel.last;
    kernel = narrower;
    if (same) break;
  }
  return kernel;
}

// Returns the rectangle lower ... upper on the light's plane that bounds the projections, from the receiver, of texels
// first ... last of a sideways face at depths depths.x ... depths.y, with a margin of one texel on every side. A part
// of a pyramid above the light's plane and below the receiver projects within its corners' projections. Of a part that
// extends to the receiver's height, only two facts are known: on which side of the receiver it projects, and that its
// point nearest to the light's plane projects nearest to the receiver.
void seen_sideways(MapFace face, ivec2 first, ivec2 last, vec2 depths, out vec2 lower, out vec2 upper) {
  const vec2 from = face.lower + vec2(first - 1) * face.texel, to = face.lower + vec2(last + 2) * face.texel;
  vec2 low = vec2(1e30), high = vec2(-1e30);  // bounds of the texels' part of space, relative to the receiver
  lower = low;
  upper = high;
  float least = 1e30, nearest_rise = 1.0;  // least ratio of a projection's distance to the point's own distance, from
                                           // the receiver; least rise
  for (int k = 0; k < 8; ++k) {
    const vec3 corner = vec3((k & 1) == 0 ? from.x : to.x, (k & 2) == 0 ? from.y : to.y, 1.0);
    const vec3 q = from_face(face, corner) * ((k & 4) == 0 ? depths.x : depths.y);
    const float rise = 1.0 - q.z / asked.e.z, scale = 1.0 / max(rise, kLeastRise);
    const vec2 away = q.xy - asked.e.xy, seen = asked.e.xy + away * scale;
    low = min(low, away);
    high = max(high, away);
    lower = min(lower, seen);
    upper = max(upper, seen);
    least = min(least, scale);
    nearest_rise = min(nearest_rise, rise);
  }
  if (nearest_rise > kLeastRise) return;
  lower = mix(asked.e.xy + low * least, vec2(-1e30), lessThan(low, vec2(0.0)));
  upper = mix(asked.e.xy + high * least, vec2(1e30), greaterThan(high, vec2(0.0)));
}

// Returns whether no texel first ... last of a face, in `layers` layers, hides light: because none is near enough to
// the light to shade the receiver, or because all of them, at their nearest depth, project outside the light. A tile's
// results depend on these texels. `projected`: the area hidden by a texel is no wider than the texel. If the result is
// false, texels that can hide light are at depths.x ... depths.y.
bool none_hides(MapFace face, ivec2 first, ivec2 last, uint layers, bool projected, out vec2 depths) {
  first = max(first, ivec2(0));
  last = min(last, ivec2(lookup.size) - 1);
  const vec2 range = depth_range(face.map, uvec2(first), uvec2(last));
  if (range.x >= 1.0) return true;
  const Bounds receiver = bounds_of(face, asked.e, asked.m);
  const float end = thresholds(receiver, face, first, last, asked.view.far).y;
  depths = asked.view.far * range;
  if (depths.x >= end) return true;
  depths.y = layers > 1 ? end : min(depths.y, end);
  if (face.axis == 2) {
    depths.y = min(depths.y, asked.e.z);
    return projected && all_beside_light(receiver, face, first, last, depths.x, light.lower, light.upper);
  }
  if (!projected) return false;
  vec2 lower, upper;
  seen_sideways(face, first, last, depths, lower, upper);
  return any(greaterThan(lower, light.upper)) || any(lessThan(upper, light.lower));
}
