// SPDX-License-Identifier: Apache-2.0
// Taps into the maps of one light point; maps/README.md has the notation.
//
// A texel holds the depth of the nearest surface in the direction of its *centre*, while the receiver lies somewhere in
// the texel. A direct comparison of the two depths shades a tilted receiver by itself (acne). So the comparison is made
// where the map's value is exact: at the point of the receiver's own plane in the direction of the texel's centre (the
// receiver-plane depth of Isidoro 2006, here exact: 1/depth of a plane is affine in the map's coordinates). The bias
// then only covers neighbouring faces that rise above the receiver's plane within the texel, and rounding.
// (receiverPlane=off: the receiver's own depth is compared, as in the papers, with acne.)

// Limit of the receiver plane's slope, in texels of depth for each texel: on a steeper plane, half a texel spans half
// the scene.
const float kSteepest = 8.0;

// Position of the direction of d, a vector in the light's basis, on the maps. d must not lie in the light's plane.
struct FaceHit {
  uint face;         // index on its side
  int axis;          // the face's axis: 0, 1, 2
  vec3 f;            // d as (a, b, w): across and along the face
  vec2 lower, upper; // of the face, in a/w and b/w
};

// Returns the position; faces and coordinates as in face_push (map_fit.cpp).
FaceHit face_hit(LightView view, vec3 d) {
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  const vec3 e = vec3(d.xy, abs(d.z));
  const vec2 across = abs(e.xy);
  FaceHit hit = FaceHit(0, 2, e, side.lower, side.upper);
  if (side.face_count > 1) {
    hit.lower = vec2(-1.0);
    hit.upper = vec2(1.0);
    if (max(across.x, across.y) > e.z) {
      hit.lower.y = 0.0;
      if (across.x >= across.y) {
        hit.face = e.x > 0.0 ? 1 : 2;
        hit.f = vec3(e.y, e.z, across.x);
        hit.axis = 0;
      } else {
        hit.face = e.y > 0.0 ? 3 : 4;
        hit.f = vec3(e.x, e.z, across.y);
        hit.axis = 1;
      }
    }
  }
  return hit;
}

// Face of a light point's maps. Directions are on the receiver's side of the light's plane: (x, y, |z|).
struct MapFace {
  vec2 lower, texel;  // border of the first texel, and a texel's extent, at depth 1
  int axis;           // 0, 1, 2
  float sign;         // of a sideways face's axis, else 1
  uint map;           // index among all maps
};

// Returns face `face` of a side, as in face_push (map_fit.cpp). `first_map`: first map of this light point.
MapFace face_of(SideView side, uint first_map, uint size, uint face) {
  MapFace f;
  vec2 lower = side.lower, upper = side.upper;
  f.axis = 2;
  f.sign = 1.0;
  if (side.face_count > 1) {
    lower = vec2(-1.0, face == 0 ? -1.0 : 0.0);
    upper = vec2(1.0);
    if (face > 0) {
      f.axis = face <= 2 ? 0 : 1;
      f.sign = face == 1 || face == 3 ? 1.0 : -1.0;
    }
  }
  f.lower = lower;
  f.texel = (upper - lower) / float(size);
  f.map = first_map + side.first_face + face;
  return f;
}

// Convert a vector to (a, b, w), across and along the face, and back.
vec3 to_face(MapFace f, vec3 e) {
  if (f.axis == 2) return e;
  return f.axis == 0 ? vec3(e.y, e.z, f.sign * e.x) : vec3(e.x, e.z, f.sign * e.y);
}
vec3 from_face(MapFace f, vec3 abw) {
  if (f.axis == 2) return abw;
  return f.axis == 0 ? vec3(f.sign * abw.z, abw.xy) : vec3(abw.x, f.sign * abw.z, abw.y);
}

// Value of the map in the direction of d, a vector in the light's basis. `direction` points to the texel's centre, with
// length one along the face's axis; the nearest surface is at depth * direction.
struct Tap {
  vec3 direction;
  float depth;      // far for an empty texel
  float second;     // depth of the surface behind; far where there is none, and where no option `depth` needs it
  float far;
  float along;      // length of d along the face's axis
  float texel;      // a texel's width at depth 1
  int axis;         // the face's axis: 0, 1, 2
  float mirrored;   // -1 where the direction is on the light's rear side, else 1
  uint number;      // index of the texel, among all maps' texels
};

// Returns texel `cell` of a face, as a tap on the receiver's side of the light's plane. The caller sets `along`.
Tap tap_of(LightView view, uint size, MapFace face, uvec2 cell) {
  Tap tap;
  tap.direction = from_face(face, vec3(face.lower + (vec2(cell) + 0.5) * face.texel, 1.0));
  const uint texel = (face.map * size + cell.y) * size + cell.x;
  tap.far = view.far;
  tap.depth = view.far * maps[texel];
  tap.second = lookup.depth_use == kDepthFirst ? view.far : view.far * maps[texel + lookup.faces * size * size];
  tap.along = 1.0;
  tap.texel = max(face.texel.x, face.texel.y);
  tap.axis = face.axis;
  tap.mirrored = 1.0;
  tap.number = texel;
  return tap;
}

#ifdef FITTED_FACES
#include "maps/host/fitted.glsl"
#else
// Returns the tap in direction d, which must not lie in the light's plane.
Tap fetch(LightView view, uint first_map, uint size, vec3 d) {
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  const FaceHit hit = face_hit(view, d);
  const MapFace face = face_of(side, first_map, size, hit.face);
  const vec2 cell = side.face_count == 0 ? vec2(0.0) : floor((hit.f.xy / hit.f.z - face.lower) / face.texel);
  const vec2 at = clamp(cell, vec2(0.0), vec2(float(size - 1)));
  Tap tap = tap_of(view, size, face, uvec2(at));
  tap.along = hit.f.z;
  tap.mirrored = d.z < 0.0 ? -1.0 : 1.0;
  tap.direction.z *= tap.mirrored;
  // Outside a window no caster matters (map_fit.cpp); a hemicube's faces meet, and only rounding leads outside one.
  if (side.face_count == 0 || (side.face_count == 1 && at != cell)) tap.depth = tap.second = view.far;
  return tap;
}
#endif

// Returns the depth at which receivers begin to be in the tap's shadow: at least `forgiven` beyond the nearest surface,
// or a depth given by the option `depth`. Wang and Molnar 1994: the second surface; Woo 1992: the middle between the
// two; Weiskopf and Ertl 2003: the bias, but no farther than the middle. Without a second surface, the middle is at the
// bias.
float begins_behind(Tap tap, float forgiven) {
  const float middle = tap.depth + 0.5 * (tap.second - tap.depth);
  const bool single = tap.second >= tap.far;
  switch (lookup.depth_use) {
    case kDepthSecond:
      return single ? tap.far * 4.0 : tap.second;
    case kDepthMidpoint:
      return single ? tap.depth + forgiven : middle;
    case kDepthDual:
      return single ? tap.depth + forgiven : min(tap.depth + forgiven, middle);
  }
  return tap.depth + forgiven;
}

// Returns whether a receiver at this depth is in the tap's shadow.
bool is_before(Tap tap, float receiver, float forgiven) {
  if (lookup.depth_use != kDepthFirst) return begins_behind(tap, forgiven) < receiver;
  return tap.depth < receiver - forgiven;
}

// Returns whether the tap's surface is nearer to the light than this depth, independent of the receiver's slope.
bool is_before_depth(Tap tap, float depth, float bias) { return is_before(tap, depth, bias * tap.texel * tap.along); }

// Depth of a receiver's plane in the direction of a tap, and the depth that the bias subtracts.
struct PlaneDepth {
  float depth, forgiven;
};

// Returns the depth of the receiver's plane: normal m away from the light, at distance h = m . p > 0 from the light
// point. A plane that the direction misses, or meets beyond `limit`, counts as at `limit`.
PlaneDepth plane_depth(Tap tap, vec3 m, float h, float limit, float bias) {
  const float facing = dot(m, tap.direction);
  const float plane = h < limit * facing ? h / facing : limit;
  // Depth of the plane per unit across, bounded: a bias of 1 covers one texel of this slope plus one texel's width.
  const float across = abs(m.x) + abs(m.y) + abs(m.z) - abs(m[tap.axis]);
  const float slope = across < kSteepest * facing ? across / facing : kSteepest;
  const float forgiven = bias * tap.texel * tap.along * (1.0 + slope);
  return PlaneDepth(plane, forgiven);
}

// Returns whether the map's surface is nearer to the light than the receiver's plane.
bool blocks(Tap tap, vec3 m, float h, float limit, float bias) {
  const PlaneDepth plane = plane_depth(tap, m, h, limit, bias);
  return is_before(tap, plane.depth, plane.forgiven);
}

// Returns whether the tap's surface lies between the receiver at d and some point of the light. The receiver's plane is
// evaluated in the tap's direction; a surface not nearer to the light's plane than the receiver is not in between.
bool blocks_light(Tap tap, vec3 d, vec3 m, float bias) {
  const float limit = d.z / tap.direction.z;
  const float h = dot(m, d);
  if (h > 0.0 && lookup.own_depth == 0) return blocks(tap, m, h, limit, bias);
  // Where the light's centre is below the receiver's horizon, the receiver's plane cannot be compared with the centre's
  // map.
  return is_before_depth(tap, limit, bias);
}

// Returns, where the light's centre is below the receiver's horizon (blocks_light), whether the tap's surface is above
// the receiver's plane by more than the bias. A surface below the plane, such as the receiver's own surface seen from
// behind, hides none of the light above the horizon. A direction leads up through the plane where m . c < 0.
bool above_plane(Tap tap, vec3 d, vec3 m, float bias) {
  const float h = dot(m, d), rising = -dot(m, tap.direction);
  if (h > 0.0 || lookup.own_depth != 0) return true;
  const float across = abs(m.x) + abs(m.y) + abs(m.z) - abs(m[tap.axis]);
  const float slope = across < kSteepest * rising ? across / rising : kSteepest;
  const float room = bias * tap.texel * tap.along * (1.0 + slope);
  return rising > 0.0 && -h < (tap.depth - room) * rising;
}

// Returns V of a receiver whose horizon leaves the fraction `above` of the light, if shadows leave the fraction `left`
// of the whole light. Occluders are above the receiver's plane and are seen above its horizon: the hidden fractions add
// up. If compared in its own depth, as published, a texel may also hide parts below the horizon: then the smaller of
// the two is the best estimate. `precise`: where `left` is a constant, compilers would add the constants first, and a
// sorting pass would round in another way than the look-up.
float visible_above(float left, float above) {
  precise const float both = left + (above - 1.0);
  return lookup.own_depth != 0 ? min(left, above) : max(both, 0.0);
}

vec3 to_basis(LightBasis basis, vec3 x) { return vec3(dot(basis.u, x), dot(basis.v, x), dot(basis.n, x)); }

// Returns the result of the hard shadow test: receiver at d from the light point, m as above; both in the light's
// basis.
bool hard_shadow(LightView view, uint first_map, uint size, vec3 d, vec3 m, float bias) {
  const Tap tap = fetch(view, first_map, size, d);
  if (lookup.own_depth != 0) return is_before_depth(tap, tap.along, bias);
  return blocks(tap, m, dot(m, d), tap.along * (1.0 + kSteepest * tap.texel), bias);
}
