// Taps into the maps of one light point; README.md has the picture.
//
// A texel holds the depth of the nearest surface in the direction of its *centre*, while the receiver lies somewhere in
// the texel. Comparing the two depths as they are shades a tilted receiver by itself (acne). So the map is asked where it
// knows the answer: at the point of the receiver's own plane in the direction of the texel's centre (the receiver-plane
// depth of Isidoro 2006, here exact: 1/depth of a plane is affine in the map's coordinates). What remains for the bias are
// neighbouring faces that rise above the receiver's plane within the texel, and rounding.

// A receiver's plane is not followed further than this many texels in depth: so steep, half a texel is half the scene.
const float kSteepest = 8.0;

// Where the direction of d, a vector in the light's basis, meets the maps. d must not lie in the light's plane.
struct Place {
  uint face;         // of its side
  int axis;          // the face's axis: 0, 1, 2
  vec3 f;            // d as (a, b, w): across and along the face
  vec2 lower, upper; // of the face, in a/w and b/w
};

// Faces and coordinates as in face_push (map_fit.cpp).
Place place_of(LightView view, vec3 d) {
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  const vec3 e = vec3(d.xy, abs(d.z));
  const vec2 across = abs(e.xy);
  Place place = Place(0, 2, e, side.lower, side.upper);
  if (side.face_count > 1) {
    place.lower = vec2(-1.0);
    place.upper = vec2(1.0);
    if (max(across.x, across.y) > e.z) {
      place.lower.y = 0.0;
      if (across.x >= across.y) {
        place.face = e.x > 0.0 ? 1 : 2;
        place.f = vec3(e.y, e.z, across.x);
        place.axis = 0;
      } else {
        place.face = e.y > 0.0 ? 3 : 4;
        place.f = vec3(e.x, e.z, across.y);
        place.axis = 1;
      }
    }
  }
  return place;
}

// What the map has in the direction of d, a vector in the light's basis. `direction` points to the texel's centre, one
// long along the face's axis; the nearest surface is at depth * direction.
struct Tap {
  vec3 direction;
  float depth;      // far where there is nothing
  float along;      // d along the face's axis
  float texel;      // a texel's width at depth 1
  int axis;         // the face's axis: 0, 1, 2
  float mirrored;   // -1 on the light's rear side, else 1
};

// `first_map`: where the maps of this light point start, in faces. d must not lie in the light's plane.
Tap fetch(LightView view, uint first_map, uint size, vec3 d) {
  Tap tap;
  tap.mirrored = d.z < 0.0 ? -1.0 : 1.0;
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  const Place place = place_of(view, d);
  tap.axis = place.axis;
  const vec2 texel = (place.upper - place.lower) / float(size);
  const vec2 cell = floor((place.f.xy / place.f.z - place.lower) / texel);
  const vec2 at = clamp(cell, vec2(0.0), vec2(float(size - 1)));
  // Beside a window there is nothing to find (map_fit.cpp); a hemicube's faces meet, and only rounding leads beside one.
  const bool beside = side.face_count == 1 && at != cell;
  const vec2 center = place.lower + (at + 0.5) * texel;
  if (tap.axis == 2) {
    tap.direction = vec3(center, 1.0);
  } else if (tap.axis == 0) {
    tap.direction = vec3(d.x > 0.0 ? 1.0 : -1.0, center);
  } else {
    tap.direction = vec3(center.x, d.y > 0.0 ? 1.0 : -1.0, center.y);
  }
  tap.direction.z *= tap.mirrored;
  tap.along = place.f.z;
  tap.texel = max(texel.x, texel.y);
  const uint map = first_map + side.first_face + place.face;
  tap.depth = side.face_count == 0 || beside ? view.far : view.far * maps[(map * size + uint(at.y)) * size + uint(at.x)];
  return tap;
}

// Is what the map has nearer to the light than the receiver's plane (normal m away from the light, at distance h = m . p
// > 0 from the light point)? A plane that the direction misses, or meets beyond `limit`, is taken to be at `limit`.
bool blocks(Tap tap, vec3 m, float h, float limit, float bias) {
  const float facing = dot(m, tap.direction);
  const float plane = h < limit * facing ? h / facing : limit;
  // Depth of the plane per unit across, bounded: a texel's worth of it, and of width, is what bias 1 forgives.
  const float across = abs(m.x) + abs(m.y) + abs(m.z) - abs(m[tap.axis]);
  const float slope = across < kSteepest * facing ? across / facing : kSteepest;
  return tap.depth < plane - bias * tap.texel * tap.along * (1.0 + slope);
}

vec3 to_basis(LightBasis basis, vec3 x) { return vec3(dot(basis.u, x), dot(basis.v, x), dot(basis.n, x)); }

// The hard shadow test: receiver at d from the light point, m as above; both in the light's basis.
bool hard_shadow(LightView view, uint first_map, uint size, vec3 d, vec3 m, float bias) {
  const Tap tap = fetch(view, first_map, size, d);
  return blocks(tap, m, dot(m, d), tap.along * (1.0 + kSteepest * tap.texel), bias);
}
