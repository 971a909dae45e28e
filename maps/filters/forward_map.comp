// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Computes V by forward mapping (Zhang 1998): see forward_map.glsl.
#include "maps/filters/forward_map.glsl"
