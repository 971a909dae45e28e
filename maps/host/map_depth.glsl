// SPDX-License-Identifier: Apache-2.0
// Returns the depth stored for a fragment: the distance along the face's axis, or 1 for fragments behind the light's
// plane, which a warped face may contain.
float map_depth(CasterPush face, vec4 at) {
  const float depth = dot(face.depth_row, vec3(at.xy, 1.0)) / (at.w * face.far);
  return depth > 0.0 ? depth : 1.0;
}

// Returns the depth with the polygon offset of OpenGL and of Vulkan's depth bias: factor times the larger change across
// a texel, plus units.
float offset_map_depth(CasterPush face, vec4 at) {
  const float depth = map_depth(face, at);
  if (face.offset_factor == 0.0 && face.offset_units == 0.0) return depth;
  // At a triangle's border, derivatives include fragments outside the triangle; these are also on the triangle's plane.
  return min(depth + face.offset_factor * max(abs(dFdx(depth)), abs(dFdy(depth))) + face.offset_units, 1.0);
}
