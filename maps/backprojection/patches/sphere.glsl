// SPDX-License-Identifier: Apache-2.0
// The patch is replaced by its bounding sphere, the light is a sphere or replaced by the disk of its area that faces
// the receiver (Bavoil and Silva 2006): computes the fraction of the light's cap of directions covered by the sphere's
// cap. Included after group_kernel.glsl, light_table.glsl; the shader has own.radius, the light's radius, and own.ball,
// whether the light is a sphere.
#include "maps/backprojection/patches/lens.glsl"

const float kHalfDiagonal = 0.70710678118655;

// Returns half the angle subtended by a sphere; from within the sphere, half of all directions. (Not asin: drivers may
// be 1e-4 off.)
float sphere_angle(float radius, float away) {
  return radius < away ? atan(radius, sqrt((away - radius) * (away + radius))) : 1.57079632679490;
}

uint sphere_hides(MapFace face, Tap tap) {
  const vec3 to_light = -asked.e, to_sphere = tap.depth * tap.direction - asked.e;
  const float radius = 0.5 * length(face.texel) * tap.depth;
  const float distance_to_light = length(to_light), distance_to_sphere = length(to_sphere);
  const float angle = sphere_angle(radius, distance_to_sphere);
  const float light_angle =
      own.ball != 0 ? sphere_angle(own.radius, distance_to_light) : atan(own.radius, distance_to_light);
  const float between = 2.0 * atan(length(to_light * distance_to_sphere - to_sphere * distance_to_light),
                                   length(to_light * distance_to_sphere + to_sphere * distance_to_light));
  // Projected stereographically from the point opposite the light's middle, all caps are disks. The result is the
  // covered fraction of the smaller cap's disk, times the area of this cap.
  const float light_radius = tan(0.5 * light_angle);
  const float near_end = tan(0.5 * (between - angle)), far_end = tan(min(0.5 * (between + angle), 1.55));
  const float radius_there = 0.5 * (far_end - near_end), smaller = min(light_radius, radius_there);
  const float covered = lens(light_radius, radius_there, 0.5 * (far_end + near_end)) / (3.14159265358979 * smaller * smaller);
  const float cap = sin(0.5 * min(light_angle, angle)) / sin(0.5 * light_angle);
  return uint(clamp(covered * cap * cap, 0.0, 1.0) * float(kWholeLight) + 0.5);
}

// Returns the bounding rectangle of the intersection of the light's plane with the cone of lines from the receiver that
// meet a sphere of the light's radius around its middle; larger than the scene where the receiver is no higher than the
// sphere.
void cone_bounds(out vec2 lower, out vec2 upper) {
  const float r = own.radius * 1.0001, z = asked.e.z;
  const float below = (z - r) * (z + r);
  lower = vec2(-1e3 * asked.view.far);
  upper = -lower;
  if (z < 1.01 * r) return;
  const vec2 middle = -r * r * asked.e.xy, half_width = r * z * sqrt(asked.e.xy * asked.e.xy + below);
  lower = (middle - half_width) / below;
  upper = (middle + half_width) / below;
}

// Returns the texels whose spheres may meet the cone of cone_bounds, if no sphere's middle is nearer to the light's
// plane than `near`. A point of a sphere is up to the sphere's radius, half a texel's diagonal, off its middle,
// sideways and toward the light; on the map this is half a diagonal times 1 + the tangent of the texel's direction.
Kernel sphere_kernel(MapFace face, uint size, inout float near, bool search) {
  // On a sideways face, a texel's lowest row extends down to the light's plane.
  if (face.axis != 2) return Kernel(ivec2(0), ivec2(int(size) - 1), true);
  vec2 lower, upper;
  cone_bounds(lower, upper);
  const vec2 widest = max(abs(face.lower), abs(face.lower + float(size) * face.texel));
  const int padding = 1 + int(ceil(kHalfDiagonal * (1.0 + max(widest.x, widest.y))));
  const float begins = 1.0 - kHalfDiagonal * max(face.texel.x, face.texel.y);
  if (search) return search_kernel(face, lower, upper, near, max(begins, 0.0), padding, true, 0);
  return kernel_on(face, size, asked.e, lower, upper, max(begins, 0.0) * near, padding);
}

// Returns the fraction of a spherical light above the receiver's horizon, by area of the visible disk: the disk within
// the circle along which lines from the receiver touch the sphere.
float sphere_above_horizon() {
  const float away = length(asked.e);
  if (away <= own.radius) return 0.0;
  const float facing = dot(asked.m, asked.e) / away, aside = sqrt(max(0.0, 1.0 - facing * facing));
  const float touching = sqrt((away - own.radius) * (away + own.radius));
  return disk_beside_line(facing * touching / max(aside * own.radius, 1e-30));
}
