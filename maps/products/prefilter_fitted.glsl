// SPDX-License-Identifier: Apache-2.0
// Windows around receivers on faces fitted to the view of a camera, or on paraboloids: part of prefilter.glsl.
//
// Through a height, the light is a rectangle of directions (x/z, y/z). On a face that is not warped this is a rectangle
// of texels, too. On a warped face its image is turned and bent, and texels have different shares of the light. So the
// window remains a rectangle of directions. Its parts have equal shares of the light and are looked up one by one: each
// is replaced by the box with the second moments of its image, as a light that is not a rectangle is replaced by its
// box (map_frame.hpp). Parts are cut in four until they are boxes to within half a texel.

// Value of Window::face for a window of directions.
const uint kDirections = 0xffffffffu;

struct Window {
  uint face;   // face whose texels the window consists of; kDirections: the window is a rectangle of directions
  uint side;   // of the light's plane
  uint alone;  // index of the receiver's only face on this side, outside which there is no caster; the number of faces
               // if there are several
  vec2 lower, upper, extent;
};

// Returns the only face on a side for receivers of this depth, or the number of faces if there are several.
uint lone_face(uint side) {
  uint found = table_of_faces.count, count = 0;
  for (uint i = 0; i < table_of_faces.count; ++i) {
    const FittedFace face = fitted_faces[i];
    if (face.side != side || receiver_depth < face.from || receiver_depth >= face.to) continue;
    found = i;
    ++count;
  }
  return count == 1 ? found : table_of_faces.count;
}

vec3 direction_in(Window window, vec2 at) {
  return window.face == kDirections ? vec3(at, 1.0) : face_direction(fitted_faces[window.face], at / float(table.size));
}

// Finds, on face `number`, the box with the second moments of a window's image. The moments of a parallelogram with
// half sides p and q are (p p^T + q q^T) / 3, those of a box with half sides h are h h / 3. Returns the largest
// distance, in texels, of one of the image's corners from the box's; infinite if the image passes the face's horizon.
float moments_on(Window window, uint number, out vec2 centre, out vec2 extent) {
  centre = 0.5 * (window.lower + window.upper);
  extent = window.extent;
  if (window.face == number) return 0.0;
  vec2 at[4];
  for (uint k = 0; k < 4; ++k) {
    const vec2 corner = vec2((k & 1) == 0 ? window.lower.x : window.upper.x, (k & 2) == 0 ? window.lower.y : window.upper.y);
    vec2 place;
    if (!face_place(fitted_faces[number], direction_in(window, corner), place)) return 1.0 / 0.0;
    at[k] = place * float(table.size);
  }
  centre = 0.25 * (at[0] + at[1] + at[2] + at[3]);
  const vec2 p = 0.25 * (at[1] + at[3] - at[0] - at[2]), q = 0.25 * (at[2] + at[3] - at[0] - at[1]);
  const vec2 half_extent = sqrt(p * p + q * q);
  extent = 2.0 * half_extent;
  float off = 0.0;
  for (uint k = 0; k < 4; ++k) {
    const vec2 beside = abs(abs(at[k] - centre) - half_extent);
    off = max(off, max(beside.x, beside.y));
  }
  return off;
}

const float kFits = 0.5;  // texels

// Returns the image of a window, or of a part, on the face that contains its middle.
Image image_of(Window window) {
  const uint none = table_of_faces.count;
  const vec3 middle = direction_in(window, 0.5 * (window.lower + window.upper));
  uint number = window.alone;
  vec2 place;
  if (number == none) {
    number = middle.z > 0.0 ? find_face(middle, window.side, place) : none;
  } else if (!face_place(fitted_faces[number], middle, place)) {
    number = none;
  }
  Image image;
  image.extent = window.face == kDirections ? vec2(table.size) : window.extent;
  image.centre = vec2(0.0);
  image.fits = false;
  image.box = Box(0, vec2(0.0), vec2(0.0), 0.0);  // in no map: there is no caster
  if (number == none) return image;
  const float off = moments_on(window, number, image.centre, image.extent);
  image.fits = off <= kFits;
  vec2 extent = image.extent;
  if (!(off < float(table.size))) {  // at the face's horizon the smallest parts are replaced by the texel of their
                                     // middle
    image.centre = floor(place * float(table.size)) + 0.5;
    image.extent = vec2(table.size);
    extent = vec2(1.0);
  }
  const vec2 lower = image.centre - 0.5 * extent, upper = image.centre + 0.5 * extent;
  const bool alone = window.alone != none, on_window = window.face == number;
  image.box = box_on(number, alone, on_window ? window.lower : lower, on_window ? window.upper : upper, extent);
  // A part that reaches onto another face is cut.
  const bool whole = all(greaterThanEqual(lower, vec2(-kFits))) && all(lessThanEqual(upper, vec2(float(table.size) + kFits)));
  image.fits = image.fits && (alone || whole);
  return image;
}

// Returns the receiver's face and place: its only face, or the first that contains it; the number of faces if none does.
uint own_face(vec3 e, uint side, uint alone, out vec2 place) {
  if (alone == table_of_faces.count) return find_face(e, side, place);
  return face_place(fitted_faces[alone], e, place) ? alone : table_of_faces.count;
}

// Returns the light's box as seen from the receiver d through height z (> 0): around the receiver's own direction, half
// as wide as half_box (1/z - 1/|d.z|) in x/z and y/z. If this window is a box of the receiver's face, it is returned as
// a window of texels, no narrower than a texel: a window of this width is the receiver's own texel.
Window window_through(LightView view, vec3 d, vec2 half_box, float z) {
  const float height = abs(d.z);
  const uint side = d.z < 0.0 ? 1 : 0, alone = lone_face(side);
  const vec2 at = d.xy / height, reach = half_box * max(1.0 / z - 1.0 / height, 0.0);
  const Window window = Window(kDirections, side, alone, at - reach, at + reach, 2.0 * reach);
  vec2 place, middle, width;
  const uint own = own_face(vec3(at, 1.0), side, alone, place);
  if (own == table_of_faces.count || !(moments_on(window, own, middle, width) <= kFits)) return window;
  const vec2 receiver = place * float(table.size);
  const vec2 centre = mix(floor(receiver) + 0.5, receiver, min(width, vec2(1.0)));
  const vec2 extent = max(width, vec2(1.0));
  return Window(own, side, alone, centre - 0.5 * extent, centre + 0.5 * extent, extent);
}

// Returns a window of `texels` texels a side around the receiver, in texels of its face: an odd window is centred on
// the receiver's texel, an even one on the texel border nearest to the receiver.
Window window_of_texels(LightView view, vec3 d, uint texels) {
  const uint side = d.z < 0.0 ? 1 : 0, alone = lone_face(side);
  const vec2 at = d.xy / abs(d.z);
  vec2 place;
  const uint own = own_face(vec3(at, 1.0), side, alone, place);
  if (own == table_of_faces.count) return Window(kDirections, side, alone, at, at, vec2(0.0));
  const vec2 first = floor(place * float(table.size) - 0.5 * float(texels) + 0.5);
  return Window(own, side, alone, first, first + float(texels), vec2(float(texels)));
}

// Returns the receiver's height less the bias: `bias` texels in depth, and more on a slope, as in blocks().
float height_less_bias(LightView view, vec3 d, vec3 m) {
  const uint side = d.z < 0.0 ? 1 : 0;
  const vec3 e = vec3(d.xy, abs(d.z));
  vec2 place;
  const uint own = own_face(e, side, lone_face(side), place);
  if (own == table_of_faces.count) return e.z;
  const FittedFace face = fitted_faces[own];
  const vec2 centre = (clamp(floor(place * float(table.size)), vec2(0.0), vec2(float(table.size - 1))) + 0.5) / float(table.size);
  const float facing = dot(m, d) / dot(face.along, e);
  const float across = abs(m.x) + abs(m.y) + abs(m.z) - abs(m[face.axis]);
  const float slope = across < kSteepest * facing ? across / facing : kSteepest;
  return e.z * max(1.0 - lookup.bias * face_texel(face, centre, table.size) * (1.0 + slope), 0.0);
}
