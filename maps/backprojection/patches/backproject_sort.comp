// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Sorting pass: computes V of receivers for which backproject.comp need not look at texels, and lists the others.
#define SORTS_OUT
#include "maps/backprojection/patches/backproject.glsl"
