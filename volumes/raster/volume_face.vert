// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "volumes/raster/volume_count.shared.h"

// Proposes pixels for one face (an instance): its screen box, as a strip of four vertices. Uses no near or far plane
// and no depth, since the fragment shader decides.

layout(scalar, binding = 0) readonly buffer Faces { VolumeFace faces[]; };
layout(scalar, push_constant) uniform Push { VolumePush push; };

// Passed on, so that the fragment shader need not read it again: some drivers read buffers one lane after the other.
layout(location = 0) flat out vec3 a;
layout(location = 1) flat out vec3 b;
layout(location = 2) flat out vec3 c;
layout(location = 3) flat out int weight;
layout(location = 4) flat out uint plane;
layout(location = 5) flat out uint part;

void main() {
  a = faces[gl_InstanceIndex].a;
  b = faces[gl_InstanceIndex].b;
  c = faces[gl_InstanceIndex].c;
  weight = faces[gl_InstanceIndex].weight;
  plane = faces[gl_InstanceIndex].plane;
  part = faces[gl_InstanceIndex].part;
  const vec2 at = faces[gl_InstanceIndex].corners[gl_VertexIndex] - vec2(0.0, float(push.first_row));
  gl_Position = vec4(at / vec2(push.width, push.row_count) * 2.0 - 1.0, 0.5, 1.0);
}
