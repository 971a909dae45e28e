// SPDX-License-Identifier: Apache-2.0
// Interface of vertex shaders to holes.glsl.
#include "maps/host/holes.shared.h"

STORAGE(1) readonly buffer Places { uint places[]; };
layout(location = 1) out vec4 place;
layout(location = 2) flat out uint surface;

void place_corner(uint corner) {
  const uint first = corner * kPlaceWords;
  place = uintBitsToFloat(uvec4(places[first], places[first + 1], places[first + 2], places[first + 3]));
  surface = places[first + 4];
}
