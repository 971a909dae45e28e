// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "volumes/raster/wedge_raster.shared.h"

// Proposes pixels for one wedge (an instance): its footprint, as a fan. Uses no near or far plane and no depth.

layout(scalar, binding = 0) readonly buffer Faces {
  WedgeFace faces[];
};
layout(scalar, push_constant) uniform Push {
  WedgePush push;
};

// Passed on, so that the fragment shader need not read it again: some drivers read buffers one lane after the other.
layout(location = 0) flat out vec3 a;
layout(location = 1) flat out vec3 b;
layout(location = 2) flat out int weight;
layout(location = 3) flat out uint number;

void main() {
  a = faces[gl_InstanceIndex].a;
  b = faces[gl_InstanceIndex].b;
  weight = faces[gl_InstanceIndex].weight;
  number = faces[gl_InstanceIndex].number;
  // Triangle t of the fan has corners 0, t + 1, t + 2. Corner numbers beyond the last are clamped to it, which gives
  // triangles without area.
  const uint triangle = gl_VertexIndex / 3, which = gl_VertexIndex % 3;
  const uint corner = min(which == 0 ? 0 : triangle + which, faces[gl_InstanceIndex].corner_count - 1);
  const vec2 at = faces[gl_InstanceIndex].corners[corner] - vec2(0.0, float(push.first_row));
  gl_Position = vec4(at / vec2(push.width, push.row_count) * 2.0 - 1.0, 0.5, 1.0);
}
