// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/products/nearest_ids.shared.h"
#include "render/both.glsl"
#include "maps/host/holes.glsl"

// Draws as nearest_ids.frag does, for surfaces with holes.

STORAGE(3) readonly buffer Ids { uint id_of[]; };  // written by the vertex shader
STORAGE(4) readonly buffer Maps { float maps[]; };
STORAGE(5) buffer Nearest { uint nearest[]; };
#include "maps/products/nearest_ids.glsl"

void main() {
  if (!is_hole()) mark_nearest();
}
