// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Sorts out the packets none of whose pixels has a contour.
#define SORTS_OUT
#include "maps/backprojection/contours/contour.glsl"
