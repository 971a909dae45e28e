// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Marks the slices that contain surfaces: see slices.glsl.
#include "maps/products/slices.shared.h"
#include "render/both.glsl"

STORAGE(1) readonly buffer Planes { SlicePlanes planes; };
STORAGE(2) buffer Bits { uint bits[]; };
#include "maps/products/slices.glsl"

void main() { mark_slice(); }
