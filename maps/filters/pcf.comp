// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Computes V by percentage-closer filtering (Reeves, Salesin, Cook 1987): see pcf.glsl.
#include "maps/filters/pcf.glsl"
