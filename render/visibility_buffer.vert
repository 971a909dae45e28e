// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "render/both.glsl"
#include "render/visibility_buffer.shared.h"

// Proposes pixels for one triangle (an instance): its box on the screen, enlarged by a pixel on every side, as a strip
// of four vertices. Conservative without conservative rasterisation; the fragment shader decides.

#ifdef PENUMBRA_OPENGL
// The struct in C++'s layout: OpenGL would give a dvec3 the space of four doubles.
STORAGE(1) readonly buffer Push {
  double numbers[13];
  uint counts[4];
};
VisibilityBufferPush camera = VisibilityBufferPush(
    dvec3(numbers[0], numbers[1], numbers[2]), dvec3(numbers[3], numbers[4], numbers[5]),
    dvec3(numbers[6], numbers[7], numbers[8]), dvec3(numbers[9], numbers[10], numbers[11]), numbers[12], counts[0],
    counts[1], counts[2], counts[3]);
#else
PUSH_CONSTANTS Push { VisibilityBufferPush camera; };
#endif

layout(location = 0) flat out uint triangle;

void main() {
  triangle = INSTANCE;
  const dvec2 size = dvec2(camera.width, camera.height);
  const double tan_x = camera.tan_half_fov * size.x / size.y;
  // Exact up to rounding, which the extra pixel covers.
  const dvec3 forward = cross(camera.up, camera.right);
  const dvec2 middle = dvec2(dot(camera.middle, camera.right), dot(camera.middle, camera.up));
  dvec2 lower = size, upper = dvec2(0.0);
  bool any_in_front = false, any_behind = false;
  for (uint i = 0; i < 3; ++i) {
    const dvec3 d = dvec3(corner_at(3 * triangle + i)) - camera.eye;
    const double z = dot(d, forward);
    const double reach = abs(d.x) + abs(d.y) + abs(d.z);
    any_in_front = any_in_front || z > 0.0;
    // At smaller z a projection could be off by a pixel; the whole screen is then proposed.
    if (z <= reach * 1e-9) {
      any_behind = true;
      continue;
    }
    const dvec2 at = dvec2(((dot(d, camera.right) / z - middle.x) / tan_x + 1.0) * 0.5 * size.x,
                           (1.0 - (dot(d, camera.up) / z - middle.y) / camera.tan_half_fov) * 0.5 * size.y);
    lower = min(lower, at);
    upper = max(upper, at);
  }
  if (any_behind) {
    lower = dvec2(0.0);
    upper = size;
  }
  lower = max(lower - 1.0, dvec2(0.0, double(camera.first_row)));
  upper = min(upper + 1.0, dvec2(size.x, double(camera.first_row + camera.row_count)));
  if (!any_in_front || lower.x >= upper.x || lower.y >= upper.y) {
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);  // all four vertices in one place, off the screen
    return;
  }
  const dvec2 corner = dvec2((VERTEX & 1u) == 0u ? lower.x : upper.x, (VERTEX & 2u) == 0u ? lower.y : upper.y);
  const dvec2 band = dvec2(size.x, double(camera.row_count));
  gl_Position = vec4(vec2((corner - dvec2(0.0, double(camera.first_row))) / band * 2.0 - 1.0), 0.5, 1.0);
}
