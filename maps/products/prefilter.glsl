// SPDX-License-Identifier: Apache-2.0
// Means of prefiltered functions over boxes of a face. Bindings PREFILTER_FIRST … PREFILTER_FIRST + 4 are the
// product's, specialization constants 0 and 1 are its scheme and its number of buffers. A look-up calls mean_over in
// one place, in a loop: compilers inline it at each call.
#include "maps/products/prefilter_value.glsl"

layout(constant_id = 0) const uint kScheme = kTable;  // a pipeline has the code of one scheme alone
// Few devices skip the cases that a switch selects for no invocation of a group: others fetch from every buffer.
layout(constant_id = 1) const uint kBuffers = kPrefilterBuffers;

layout(scalar, binding = PREFILTER_FIRST) readonly buffer Table { PrefilterTable table; PrefilterValue values[]; };
layout(scalar, binding = PREFILTER_FIRST + 1) readonly buffer Images0 { uint images0[]; };
layout(scalar, binding = PREFILTER_FIRST + 2) readonly buffer Images1 { uint images1[]; };
layout(scalar, binding = PREFILTER_FIRST + 3) readonly buffer Images2 { uint images2[]; };
layout(scalar, binding = PREFILTER_FIRST + 4) readonly buffer Images3 { uint images3[]; };

#ifndef PREFILTER_FETCHES  // counted by a test
#define PREFILTER_FETCHES
#endif

// Box of texels of one face, lower < upper unless it is empty, within [0, size].
struct Box {
  uint face;     // of the light point
  vec2 lower, upper;
  float inside;  // fraction of the window in the map; outside the map there is no caster
};

uint word_at(uint block, uint place) {
  PREFILTER_FETCHES;
  if (kBuffers == 1) return images0[block * table.block + place];
  const uint at = block % table.per_buffer * table.block + place;
  switch (block / table.per_buffer) {
    case 0: return images0[at];
    case 1: return images1[at];
    case 2: return images2[at];
    default: return images3[at];
  }
}

// ---- summed areas

// Columns and rows at whose crossings sums of all texels below and to the left are read: none lies beyond the border.
struct Corners {
  uvec4 x, y;
};

uint sum_below(uint block, uint face, uint x, uint y) {
  return x == 0 || y == 0 ? 0 : word_at(block, (face * table.size + y - 1) * table.size + x - 1);
}

// Returns the first column, the range of columns completely in the box, and the last column.
uvec4 borders(float lower, float upper) {
  const uint first = uint(floor(lower)), last = uint(ceil(upper));
  return uvec4(first, first + 1, max(first + 1, last - 1), max(last, first + 1));
}
vec3 shares(float lower, float upper, uvec4 at) {
  if (at.w == at.y) return vec3(upper - lower, 0.0, 0.0);
  return vec3(float(at.y) - lower, 1.0, upper - float(at.z));
}

float mean_of_table(PrefilterValue value, Box box, float log2_scale) {
  const uvec4 x = borders(box.lower.x, box.upper.x), y = borders(box.lower.y, box.upper.y);
  const vec3 share_x = shares(box.lower.x, box.upper.x, x), share_y = shares(box.lower.y, box.upper.y, y);
  float mean = 0.0;
  for (uint limb = 0; limb < value.limbs; ++limb) {
    float sum = 0.0;
    uvec4 below;
    for (uint j = 0; j < 4; ++j) {
      uvec4 row;
      for (uint i = 0; i < 4; ++i) row[i] = sum_below(value.first_block + limb, box.face, x[i], y[j]);
      if (j > 0) {
        const uvec4 band = row - below;  // modulo 2^32, as the sums
        sum += share_y[j - 1] * dot(share_x, vec3(band.yzw - band.xyz));
      }
      below = row;
    }
    mean += sum * exp2(log2_scale - float(value.bits * (limb + 1)));
  }
  const vec2 extent = box.upper - box.lower;
  return mean / (extent.x * extent.y);
}

// ---- levels

float texel_of(uint block, uint offset, uint side, uint face, ivec2 at) {
  const uvec2 texel = uvec2(clamp(at, ivec2(0), ivec2(int(side) - 1)));
  return uintBitsToFloat(word_at(block, offset + (face * side + texel.y) * side + texel.x));
}

// Interpolates between the four texels around `at`, in texels.
float between_texels(uint block, uint offset, uint side, uint face, vec2 at) {
  const vec2 first = floor(at), part = at - first;
  const ivec2 i = ivec2(first);
  const float lower = mix(texel_of(block, offset, side, face, i), texel_of(block, offset, side, face, i + ivec2(1, 0)),
                          part.x);
  const float upper = mix(texel_of(block, offset, side, face, i + ivec2(0, 1)),
                          texel_of(block, offset, side, face, i + ivec2(1, 1)), part.x);
  return mix(lower, upper, part.y);
}

float mean_of_pyramid(PrefilterValue value, Box box) {
  const vec2 extent = max(box.upper - box.lower, vec2(1.0)), center = 0.5 * (box.lower + box.upper);
  // Level whose texels have the size of the box.
  const float level = clamp(0.5 * log2(extent.x * extent.y), 0.0, float(table.levels - 1));
  float means[2];
  uint offset = 0;
  for (uint l = 0; l <= min(uint(level) + 1, table.levels - 1); ++l) {
    const uint side = (table.size + (1u << l) - 1) >> l;
    if (l >= uint(level)) {
      const vec2 at = center / float(1u << l) - 0.5;
      means[l - uint(level)] = between_texels(value.first_block, offset, side, box.face, at);
    }
    offset += table.faces * side * side;
  }
  const float part = level - floor(level);
  return part == 0.0 ? means[0] : mix(means[0], means[1], part);
}

// Largest number of squares along an axis, for any proportion of the box.
const uint kMostSquares = 8;

float mean_of_windows(PrefilterValue value, Box box) {
  const vec2 extent = max(box.upper - box.lower, vec2(1.0));
  const uint level = min(uint(log2(min(extent.x, extent.y))), table.levels - 1);
  const float side = float(1u << level);
  const uvec2 count = min(uvec2(ceil(extent / side)), uvec2(kMostSquares));
  const vec2 step = max(extent - side, vec2(0.0)) / max(vec2(count) - 1.0, vec2(1.0));
  const uint offset = level * table.faces * table.size * table.size;
  const vec2 last = vec2(float(table.size) - side);
  float sum = 0.0;
  for (uint j = 0; j < count.y; ++j) {
    for (uint i = 0; i < count.x; ++i) {
      const vec2 at = clamp(box.lower + vec2(i, j) * step, vec2(0.0), last);
      // At an integer position, including the last, there is no interpolation: the neighbours have weight 0.
      sum += between_texels(value.first_block, offset, table.size, box.face, at);
    }
  }
  return sum / float(count.x * count.y);
}

// Returns the mean of function `index` over the window, times 2^log2_scale.
float mean_over(uint index, Box box, float log2_scale) {
  const PrefilterValue value = values[index];
  float mean = 0.0;
  if (box.inside > 0.0) {
    if (kScheme == kTable) {
      mean = mean_of_table(value, box, log2_scale);
    } else {
      mean = (kScheme == kPyramid ? mean_of_pyramid(value, box) : mean_of_windows(value, box)) * exp2(log2_scale);
    }
  }
  if (box.inside >= 1.0) return mean;
  const float nothing = value.kind == kBit ? 0.0 : prefilter_value(value, 1.0);
  return box.inside * mean + (1.0 - box.inside) * nothing * exp2(log2_scale);
}

// ---- windows

// Returns the part of a rectangle of texels that is in the map. `extent`: upper - lower. `alone`: whether there is no
// caster outside the face.
Box box_on(uint face, bool alone, vec2 lower, vec2 upper, vec2 extent) {
  Box box;
  box.face = face;
  box.lower = clamp(lower, vec2(0.0), vec2(table.size));
  box.upper = clamp(upper, vec2(0.0), vec2(table.size));
  const vec2 inside = box.upper - box.lower;
  // Exact comparison: a fraction off by its last digit would add a part outside the map, and an exponential of the
  // whole depth would amplify it.
  const bool whole = box.lower == lower && box.upper == upper;
  // Outside the window of a map there is no caster. Outside a face of a hemicube there are other faces, and the part on
  // this face is assumed to be representative of them.
  box.inside = inside.x > 0.0 && inside.y > 0.0 ? (alone && !whole ? inside.x * inside.y / (extent.x * extent.y) : 1.0)
                                                : 0.0;
  return box;
}

// Part of a window on a face.
struct Image {
  Box box;
  vec2 centre, extent;  // in texels
  bool fits;            // the part is this box, to within half a texel, and all of it is on one face
};

#ifdef FITTED_FACES
#include "maps/products/prefilter_fitted.glsl"
#else
// Window of texels of one face, as requested by a look-up: it may extend outside the map.
struct Window {
  uint face;   // of the light point
  bool alone;  // the face is the whole side of the light's plane: outside the face there is no caster
  vec2 lower, upper, extent;
};

// Returns the part of a window that is in the map.
Box box_of(Window window) { return box_on(window.face, window.alone, window.lower, window.upper, window.extent); }

Image image_of(Window window) {
  return Image(box_of(window), 0.5 * (window.lower + window.upper), window.extent, true);
}

// Returns the light's box as seen from the receiver d through height z (> 0): around the receiver's own direction, half
// as wide as half_box (1/z - 1/|d.z|) in x/z and y/z. It is no narrower than a texel: a box of this width is the
// receiver's own texel.
Window window_through(LightView view, vec3 d, vec2 half_box, float z) {
  const float height = abs(d.z);
  const FaceHit hit = face_hit(view, d);
  const vec2 texel = (hit.upper - hit.lower) / float(table.size);
  const vec2 at = hit.f.xy / hit.f.z;
  vec2 reach = half_box * max(1.0 / z - 1.0 / height, 0.0);
  // On a sideways face, a = other / side and b = height / side: the box that contains the window, to first order.
  if (hit.axis == 0) reach = at.y * vec2(reach.y + abs(at.x) * reach.x, at.y * reach.x);
  if (hit.axis == 1) reach = at.y * vec2(reach.x + abs(at.x) * reach.y, at.y * reach.y);
  const vec2 center = (at - hit.lower) / texel, width = 2.0 * reach / texel;
  const vec2 own = mix(floor(center) + 0.5, center, min(width, vec2(1.0)));
  const vec2 extent = max(width, vec2(1.0));
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  return Window(side.first_face + hit.face, side.face_count == 1, own - 0.5 * extent, own + 0.5 * extent, extent);
}

Box box_through(LightView view, vec3 d, vec2 half_box, float z) { return box_of(window_through(view, d, half_box, z)); }

// Returns a window of `texels` texels a side around the receiver: an odd window is centred on the receiver's texel, an
// even one on the texel border nearest to the receiver.
Window window_of_texels(LightView view, vec3 d, uint texels) {
  const FaceHit hit = face_hit(view, d);
  const vec2 at = (hit.f.xy / hit.f.z - hit.lower) * float(table.size) / (hit.upper - hit.lower);
  const vec2 first = floor(at - 0.5 * float(texels) + 0.5);
  const SideView side = view.side[d.z < 0.0 ? 1 : 0];
  return Window(side.first_face + hit.face, side.face_count == 1, first, first + float(texels), vec2(float(texels)));
}

// Returns the receiver's height less the bias: `bias` texels in depth, and more on a slope, as in blocks().
float height_less_bias(LightView view, vec3 d, vec3 m) {
  const FaceHit hit = face_hit(view, d);
  const vec2 texels = (hit.upper - hit.lower) / float(lookup.size);
  const float facing = dot(m, d) / hit.f.z;
  const float across = abs(m.x) + abs(m.y) + abs(m.z) - abs(m[hit.axis]);
  const float slope = across < kSteepest * facing ? across / facing : kSteepest;
  return abs(d.z) * max(1.0 - lookup.bias * max(texels.x, texels.y) * (1.0 + slope), 0.0);
}
#endif

// Returns part `index` of a level of cuts in four, in Morton order.
Window part_of(Window window, uint level, uint index) {
  if (level == 0) return window;
  uvec2 cell = uvec2(0);
  for (uint bit = 0; bit < level; ++bit) cell |= uvec2(index >> (2 * bit) & 1, index >> (2 * bit + 1) & 1) << bit;
  window.extent /= float(1u << level);
  window.lower += vec2(cell) * window.extent;
  window.upper = window.lower + window.extent;
  return window;
}
