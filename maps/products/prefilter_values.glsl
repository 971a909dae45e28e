// SPDX-License-Identifier: Apache-2.0
#include "maps/products/prefilter_value.glsl"

// Writes the values of each texel: as digits to be summed, or as the finest level of means. One invocation for each
// texel.

layout(local_size_x = 64) in;
// Constants: devices that do not skip code excluded by a condition would otherwise run it for each value.
layout(constant_id = 0) const uint kScheme = kTable;
layout(constant_id = 1) const uint kOfBits = 0;  // 1: texels are words of bits; else depths
layout(constant_id = 2) const uint kSlope = 0;   // 1: squares of layers include the slope's part
layout(scalar, binding = 0) readonly buffer Table { PrefilterTable table; PrefilterValue values[]; };
layout(scalar, binding = 1) readonly buffer Texels { uint texels[]; };  // bits of depths, or words of bits
layout(scalar, binding = 2) readonly buffer Views { LightView views[]; };
layout(scalar, binding = 3) readonly buffer Nearest { float nearest[2]; };
layout(scalar, binding = 4) readonly buffer Frame { MapFrame frame; };
layout(scalar, binding = 5) buffer Images0 { uint images0[]; };
layout(scalar, binding = 6) buffer Images1 { uint images1[]; };
layout(scalar, binding = 7) buffer Images2 { uint images2[]; };
layout(scalar, binding = 8) buffer Images3 { uint images3[]; };
#ifdef FITTED_FACES
#include "maps/host/fitted_face.glsl"
layout(scalar, binding = 9) readonly buffer Faces {
  FaceTable table_of_faces;
  FittedFace fitted_faces[];
};
#endif
layout(scalar, push_constant) uniform Push { PrefilterValuesPush push; };

void write(uint block, uint texel, uint word) {
  const uint at = block % table.per_buffer * table.block + texel;
  switch (block / table.per_buffer) {
    case 0: images0[at] = word; break;
    case 1: images1[at] = word; break;
    case 2: images2[at] = word; break;
    default: images3[at] = word; break;
  }
}

float height_of(uint texel, float depth) {
  const uint row = texel / table.size, map = row / table.size;
  const LightView view = views[0];
  const uint s = map >= view.side[0].first_face + view.side[0].face_count ? 1 : 0;
  if (!(depth < 1.0)) return 1.0;  // empty: as far as the deepest receiver
#ifdef FITTED_FACES
  const vec2 place = (vec2(texel % table.size, row % table.size) + 0.5) / float(table.size);
  const float height = face_height(fitted_faces[map], place);
#else
  // On a sideways face of a hemicube, the distance from the plane varies along its rows.
  const bool sideways = map != view.side[s].first_face;
  const float height = sideways ? (float(row % table.size) + 0.5) / float(table.size) : 1.0;
#endif
  return normalised_height(depth * view.far * height, nearest[s], frame.deepest[s]);
}

// Returns the change of height from texel to texel across a row and up a column: the smaller of the differences to the
// neighbours on either side, so that an outline does not count as a slope.
vec2 slope_of(uint texel, float t) {
  const ivec2 at = ivec2(texel % table.size, texel / table.size % table.size);
  vec2 slope = vec2(0.0);
  for (uint axis = 0; axis < 2; ++axis) {
    const int stride = axis == 0 ? 1 : int(table.size);
    if (at[axis] == 0 || at[axis] == int(table.size) - 1) continue;
    const uint before = uint(int(texel) - stride), behind = uint(int(texel) + stride);
    const float fall = t - height_of(before, uintBitsToFloat(texels[before]));
    const float rise = height_of(behind, uintBitsToFloat(texels[behind])) - t;
    slope[axis] = abs(fall) < abs(rise) ? fall : rise;
  }
  return slope;
}

void main() {
  const uint texel = (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x) * gl_WorkGroupSize.x +
                     gl_LocalInvocationID.x;
  if (texel >= push.texels) return;
  const uint word = texels[texel];
  const float t = kOfBits != 0 ? 0.0 : height_of(texel, uintBitsToFloat(word));
  for (uint i = 0; i < table.value_count; ++i) {
    const PrefilterValue value = values[i];
    float x = prefilter_value(value, kOfBits != 0 ? float(word >> uint(value.a) & 1) : t);
    const float layer = value.a * t - value.b;  // outside a layer, heights are those of its border
    if (kSlope != 0 && value.kind == kLayer && value.power == kSquared && layer > 0.0 && layer < 1.0) {
      // Lauritzen 2007 (Eisemann et al. 2009, box "Depth bias"): a quarter of the squared derivatives.
      const vec2 slope = value.a * slope_of(texel, t);
      x += 0.25 * dot(slope, slope);
    }
    if (kScheme != kTable) {
      write(value.first_block, texel, floatBitsToUint(x));
      continue;
    }
    if (value.bits != 0) x = min(x, 1.0 - 1.0 / 16777216.0);  // below 1: a digit has no carry
    for (uint limb = 0; limb < value.limbs; ++limb) {
      x *= float(1u << value.bits);
      const float digit = floor(x);
      x -= digit;
      write(value.first_block + limb, texel, uint(digit));
    }
  }
}
