// SPDX-License-Identifier: Apache-2.0
// Coarse levels of a map in place of the map (Guennebaud, Barthe and Paulin 2007; Schwarz and Stamminger 2008): a texel
// of level l has the nearest depth of 2^l x 2^l texels. Either one level serves all receivers, or a receiver uses the
// finest level on which its kernel has no more texels than a budget. A level between two whole levels is a blend of
// both: the coarser is weighted by the fraction. Included after kernel.glsl and taps.glsl; the shader has own.level,
// own.budget and own.blend, and first defines
//   LEVEL_MAPS        the binding of LevelMaps' buffer
//   const uint kLevels   kFinestLevel ...
#include "maps/backprojection/level_maps.shared.h"

layout(scalar, binding = LEVEL_MAPS) readonly buffer Levels { uvec2 levels[]; };  // written by level_maps.comp

uint level_at_hand = 0;
uint level_start = 0;  // first texel of the current level in `levels`

uint level() { return kLevels == kFinestLevel ? 0 : level_at_hand; }

uint side_of_level(uint l) { return ((lookup.size - 1) >> l) + 1; }
uint level_size() { return side_of_level(level()); }

void look_at_level(uint l) {
  level_at_hand = l;
  level_start = 0;
  if (kLevels != kLevelsByBudget) return;  // the only level
  for (uint k = 1; k < l; ++k) level_start += lookup.layers * lookup.faces * side_of_level(k) * side_of_level(k);
}

// Returns the face with texels of the current level.
MapFace at_level(MapFace face) {
  face.texel *= float(1u << level());
  return face;
}

// Returns a texel of a coarse level, as tap_of (taps.glsl) returns one of the map; `face` has texels of the level.
Tap level_tap(LightView view, MapFace face, uint layer, uvec2 cell) {
  const uint side = level_size();
  const uint texel = level_start + ((face.map + layer * lookup.faces) * side + cell.y) * side + cell.x;
  Tap tap;
  tap.direction = from_face(face, vec3(face.lower + (vec2(cell) + 0.5) * face.texel, 1.0));
  tap.far = view.far;
  tap.depth = view.far * uintBitsToFloat(levels[texel].x);
  tap.second = view.far;
  if (lookup.depth_use != kDepthFirst) tap.second *= uintBitsToFloat(levels[texel + lookup.faces * side * side].x);
  tap.along = 1.0;
  tap.texel = max(face.texel.x, face.texel.y);
  tap.axis = face.axis;
  tap.mirrored = 1.0;
  return tap;
}

// Returns the level for a kernel of `extent` texels: a number that grows continuously with the extent.
float wanted_level(ivec2 extent) {
  if (kLevels != kLevelsByBudget) return float(own.level);
  const float over = 0.5 * log2(float(extent.x) * float(extent.y) / float(own.budget));
  return min(float(own.level) + max(over, 0.0), float(kCoarsestLevel));
}

// Return the finer of the two levels of a blend, and the weight of the coarser; without blending, the next whole level.
uint finer_level(float wanted) { return uint(own.blend != 0 ? floor(wanted) : ceil(wanted)); }
float coarser_part(float wanted) { return own.blend != 0 ? fract(wanted) : 0.0; }
