// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Computes V as forward_map.comp does, from faces fitted to the view of a camera.
#define FITTED_FACES
#include "maps/filters/forward_map.glsl"
