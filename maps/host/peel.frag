// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Draws the next layer of a map by depth peeling: see peel.glsl.
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"
#include "maps/host/map_depth.glsl"

STORAGE(1) readonly buffer Maps { float maps[]; };
#include "maps/host/peel.glsl"

void main() { peel(); }
