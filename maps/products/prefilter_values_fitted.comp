// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Computes the same as prefilter_values.comp, for faces fitted to the view of a camera.
#define FITTED_FACES
#include "maps/products/prefilter_values.glsl"
