// What both forms of soft-shadow-map do with one occluder texel and one receiver texel (Atty et al. 2006, section 3.4): the
// texel is a rectangle parallel to the light at its own depth; seen from the receiver it covers a part of the light. Included
// after soft_shadow_map.shared.h and the push constants `push`.

// Places on an axis of the light, from its one side to the other, in units of 2^-20: neighbours at one depth have the same
// border, so that what they cover adds up without a rest.
uvec2 places(vec2 x) { return uvec2(clamp(x / (2.0 * push.half_light) + 0.5, 0.0, 1.0) * 1048576.0 + 0.5); }

// What the texel at `depth` covers of the light, seen from the receiver texel with tangents `at` and depth z, in units of
// 2^-40 of the light, low and high word. Nothing where it does not stand before the receiver.
uvec2 patch_units(vec2 at, float z, uvec2 texel, float depth) {
  const float width = max(push.occluder_texel.x, push.occluder_texel.y);
  if (!(depth + push.bias * width * z < z) || !(depth < z)) return uvec2(0);
  // precise: the same bits in whatever shader.
  precise const float to_light = depth * z / (z - depth);
  precise const vec2 from = push.occluder_lower + vec2(texel) * push.occluder_texel;
  precise const vec2 to = push.occluder_lower + vec2(texel + 1) * push.occluder_texel;
  precise const vec2 a = (from - at) * to_light, b = (to - at) * to_light;
  const uvec2 extent = places(b) - places(a);
  uint high, low;
  umulExtended(extent.x, extent.y, high, low);
  return uvec2(low, high);
}

// 2^40 units are the whole light.
float share_of(uvec2 units) { return (float(units.y) * 4294967296.0 + float(units.x)) / 1099511627776.0; }
float visible_after(uvec2 units) { return units.y >= 256 ? 0.0 : 1.0 - share_of(units); }

vec2 receiver_tangents(uvec2 texel) {
  precise const vec2 at = push.receiver_lower + (vec2(texel) + 0.5) * push.receiver_texel;
  return at;
}
