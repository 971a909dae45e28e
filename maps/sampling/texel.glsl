// SPDX-License-Identifier: Apache-2.0
// Texel in a direction, for look-ups of lists in place of depths, or of several buffers of maps. Included after
// taps.glsl.
struct Texel {
  uint index;      // in the buffer of maps; kNoTexel outside all maps
  vec3 direction;  // to the texel's centre, of length one along the face's axis
  float along;     // length of d along the face's axis
  int axis;        // the face's axis: 0, 1, 2
  vec3 across[2];  // from the texel's centre to its neighbours', in the direction of the face's first and second
                   // coordinate
  vec2 widths;     // lengths of `across`
  vec2 off;        // d relative to the texel's centre, in texels: -1/2 ... 1/2
};
const uint kNoTexel = 0xffffffffu;

// Returns the texel in direction d, which must not lie in the light's plane. `first_map`: first map of this light
// point, in faces.
Texel locate(LightView view, uint first_map, uint size, vec3 d) {
  const float mirrored = d.z < 0.0 ? -1.0 : 1.0;
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  const vec3 e = vec3(d.xy, abs(d.z));
  const vec2 size_across = abs(e.xy);

  // Faces as in face_of (map_fit.cpp), with coordinates f.
  uint face = 0;
  vec3 f = e, first = vec3(1.0, 0.0, 0.0), second = vec3(0.0, 1.0, 0.0), axis = vec3(0.0, 0.0, mirrored);
  vec2 lower = side.lower, upper = side.upper;
  Texel texel;
  texel.axis = 2;
  if (side.face_count > 1) {
    lower = vec2(-1.0);
    upper = vec2(1.0);
    if (max(size_across.x, size_across.y) > e.z) {
      lower.y = 0.0;
      second = vec3(0.0, 0.0, mirrored);
      if (size_across.x >= size_across.y) {
        face = e.x > 0.0 ? 1 : 2;
        f = vec3(e.y, e.z, size_across.x);
        first = vec3(0.0, 1.0, 0.0);
        axis = vec3(sign(e.x), 0.0, 0.0);
        texel.axis = 0;
      } else {
        face = e.y > 0.0 ? 3 : 4;
        f = vec3(e.x, e.z, size_across.y);
        axis = vec3(0.0, sign(e.y), 0.0);
        texel.axis = 1;
      }
    }
  }
  texel.widths = (upper - lower) / float(size);
  const vec2 cell = floor((f.xy / f.z - lower) / texel.widths), at = clamp(cell, vec2(0.0), vec2(float(size - 1)));
  const vec2 centre = lower + (at + 0.5) * texel.widths;
  texel.direction = centre.x * first + centre.y * second + axis;
  texel.along = f.z;
  texel.across[0] = texel.widths.x * first;
  texel.across[1] = texel.widths.y * second;
  texel.off = (f.xy / f.z - centre) / texel.widths;
  // Outside a window no caster matters (map_fit.cpp); a hemicube's faces meet, and only rounding leads outside one.
  const bool beside = side.face_count == 1 && at != cell;
  const uint map = first_map + side.first_face + face;
  texel.index = side.face_count == 0 || beside ? kNoTexel : (map * size + uint(at.y)) * size + uint(at.x);
  return texel;
}

// Returns the depth of the receiver's plane (normal m away from the light, at distance h = m . p from the light point)
// in the texel's direction, as in blocks() of taps.glsl, and in `forgiven` the bias there. Where the light point is
// below the receiver's horizon its plane cannot be compared, and the receiver's own depth is returned.
float plane_depth(Texel texel, vec3 m, float h, float bias, out float forgiven) {
  const float width = max(texel.widths.x, texel.widths.y), limit = texel.along * (1.0 + kSteepest * width);
  const float facing = dot(m, texel.direction);
  forgiven = bias * width * texel.along;
  if (h <= 0.0) return texel.along;
  const float across = abs(m.x) + abs(m.y) + abs(m.z) - abs(m[texel.axis]);
  forgiven *= 1.0 + (across < kSteepest * facing ? across / facing : kSteepest);
  return h < limit * facing ? h / facing : limit;
}
