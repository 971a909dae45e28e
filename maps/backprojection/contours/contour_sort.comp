// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Sorting pass of contour.comp: computes V of packets none of whose pixels has a contour, and lists the others.
#define SORTS_OUT
#include "maps/backprojection/contours/contour.glsl"
