// The search for a receiver's kernel (Guennebaud, Barthe and Paulin 2006): nothing in it is nearer to the light than its
// nearest depth, which makes a narrower kernel, with a nearest depth of its own, until it stays as it is. Where its
// deepest texel, too, is in front of the receiver, all of the light is hidden. Included after group_kernel.glsl, with
// PYRAMID_BINDING.
#include "maps/backprojection/thresholds.glsl"
#include "maps/products/depth_pyramid.glsl"

const int kSearchRounds = 4;

// Is the receiver behind all that a kernel's texels hold? Bounds for blocks_light over the kernel: of the receiver's
// plane, whose depth h / (m . c) is least where m . c is largest, at a corner, and of what the bias forgives there.
bool behind_all(MapFace face, Kernel kernel, float deepest) {
  const vec2 lower = face.lower + (vec2(kernel.first) + 0.5) * face.texel;
  const vec2 upper = face.lower + (vec2(kernel.last) + 0.5) * face.texel;
  const vec3 m = asked.m;
  const float facing = m.z + max(m.x * lower.x, m.x * upper.x) + max(m.y * lower.y, m.y * upper.y);
  const float least_facing = m.z + min(m.x * lower.x, m.x * upper.x) + min(m.y * lower.y, m.y * upper.y);
  const float h = dot(m, asked.e);
  float limit = asked.e.z, slope = 0.0;
  if (h > 0.0 && lookup.own_depth == 0) {
    if (h < limit * facing) limit = h / facing;
    const float across = abs(m.x) + abs(m.y);
    slope = across < kSteepest * least_facing ? across / least_facing : kSteepest;
  }
  return deepest < limit - lookup.bias * max(face.texel.x, face.texel.y) * asked.e.z * (1.0 + slope);
}

// near: of the whole map, and then the kernel's; lower, upper, padding: as kernel_on takes them. `begins`: what stands for
// a texel reaches up to so much of its height, 1 if it is all there. `umbra`: whether a kernel that hides as a whole ends
// the search.
Kernel search_kernel(MapFace face, vec2 lower, vec2 upper, inout float near, float begins, int padding, bool umbra) {
  Kernel kernel = kernel_on(face, lookup.size, asked.e, lower, upper, begins * near, padding);
  for (int round = 0; round < kSearchRounds && !is_empty(kernel); ++round) {
    const vec2 range = depth_range(face.map, uvec2(kernel.first), uvec2(kernel.last));
    if (range.x >= 1.0) return kNoKernel;
    const float depth = range.x * asked.view.far;
    // Sideways, a texel of row b is b times its depth over the light's plane.
    const float height = face.axis == 2 ? depth : depth * (float(kernel.first.y) + 0.5) * face.texel.y;
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

// Texels first ... last of a face, all that a tile's answers depend on, in so many layers: is none of them near enough to the
// light to shade the receiver, or are all of them, no nearer than their nearest, seen beside the light? `projected`: what
// they hide is no wider than they are. Else what can hide light is at depths.x ... depths.y.
bool none_hides(MapFace face, ivec2 first, ivec2 last, uint layers, bool projected, out vec2 depths) {
  first = max(first, ivec2(0));
  last = min(last, ivec2(lookup.size) - 1);
  const vec2 range = depth_range(face.map, uvec2(first), uvec2(last));
  if (range.x >= 1.0) return true;
  const Bounds receiver = bounds_of(face, asked.e, asked.m);
  const float end = thresholds(receiver, face, first, last, asked.view.far).y;
  depths = asked.view.far * range;
  if (depths.x >= end) return true;
  depths.y = min(layers > 1 ? end : min(depths.y, end), asked.e.z);
  return projected && all_beside_light(receiver, face, first, last, depths.x, light.lower, light.upper);
}
