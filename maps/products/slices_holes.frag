// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/slices.shared.h"
#include "render/both.glsl"
#include "maps/host/holes.glsl"

// Draws as slices.frag does, for surfaces with holes.

STORAGE(3) readonly buffer Planes { SlicePlanes planes; };
STORAGE(4) buffer Bits { uint bits[]; };
#include "maps/products/slices.glsl"

void main() {
  if (!is_hole()) mark_slice();
}
