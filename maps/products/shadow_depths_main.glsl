// SPDX-License-Identifier: Apache-2.0
#include "maps/products/shadow_depths.shared.h"
#include "maps/products/shadow_depths.glsl"

// Replaces each texel's nearest depth by the depth at which its shadow begins. One invocation for each texel.

layout(local_size_x = 64) in;
layout(scalar, binding = 0) buffer Maps { float maps[]; };
#ifdef FITTED_FACES
#include "maps/host/fitted_face.glsl"
layout(scalar, binding = 1) readonly buffer Faces {
  FaceTable table_of_faces;
  FittedFace fitted_faces[];
};
#else
layout(scalar, binding = 1) readonly buffer Views { LightView views[]; };
#endif
layout(scalar, push_constant) uniform Push { ShadowDepthsPush push; };

void main() {
  const uint texel = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x +
                     gl_LocalInvocationID.x;
  const uint layer = push.faces * push.size * push.size;
  if (texel >= layer) return;
  const uint face = texel / (push.size * push.size);
#ifdef FITTED_FACES
  const vec2 centre = (vec2(texel % push.size, texel / push.size % push.size) + 0.5) / float(push.size);
  const float width = face_texel(fitted_faces[face], centre, push.size);
#else
  const LightView view = views[0];
  const SideView side = view.side[face >= view.side[0].first_face + view.side[0].face_count ? 1 : 0];
  const vec2 extent = side.face_count == 1 ? side.upper - side.lower : vec2(2.0);
  const float width = max(extent.x, extent.y) / float(push.size);
#endif
  const float forgiven = min(push.bias * width, 1.0);
  if (maps[texel] < 1.0) maps[texel] = shadow_begins(push.depth_use, maps[texel], maps[layer + texel], forgiven);
}
