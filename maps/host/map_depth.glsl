// What a map holds of a fragment: the distance along the face's axis, or that nothing is there, which in a warped face may be
// seen in directions that lead behind the light's plane.
float map_depth(CasterPush face, vec4 at) {
  const float depth = dot(face.depth_row, vec3(at.xy, 1.0)) / (at.w * face.far);
  return depth > 0.0 ? depth : 1.0;
}

// The same with the polygon offset of OpenGL and of Vulkan's depth bias: factor times the larger change across a texel, and
// units.
float offset_map_depth(CasterPush face, vec4 at) {
  const float depth = map_depth(face, at);
  if (face.offset_factor == 0.0 && face.offset_units == 0.0) return depth;
  // Where a triangle ends its neighbour's fragments are on its plane, too.
  return min(depth + face.offset_factor * max(abs(dFdx(depth)), abs(dFdy(depth))) + face.offset_units, 1.0);
}
