// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Computes the depths of shadows in windows and hemicubes: see shadow_depths_main.glsl.
#include "maps/products/shadow_depths_main.glsl"
