// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Writes the values of each texel of windows and hemicubes: see prefilter_values.glsl.
#include "maps/products/prefilter_values.glsl"
