// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Writes the ids of the nearest triangles: see nearest_ids.glsl.
#include "maps/products/nearest_ids.shared.h"
#include "render/both.glsl"

STORAGE(1) readonly buffer Ids { uint id_of[]; };  // written by the vertex shader
STORAGE(2) readonly buffer Maps { float maps[]; };
STORAGE(3) buffer Nearest { uint nearest[]; };
#include "maps/products/nearest_ids.glsl"

void main() { mark_nearest(); }
