// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Computes V of receivers that backproject_peel_sort.comp has left.
#include "maps/backprojection/patches/backproject_peel.glsl"
