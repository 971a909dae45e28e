// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"
#include "maps/host/holes.glsl"
#include "maps/host/map_depth.glsl"

// Peels as peel.frag does, for surfaces with holes.

STORAGE(3) readonly buffer Maps { float maps[]; };
#include "maps/host/peel.glsl"

void main() {
  if (is_hole()) discard;
  peel();
}
