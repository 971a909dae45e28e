// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Computes V as pcf.comp does; a texel that shows the receiver's own object never shades it (Brabec and Seidel 2002).
#define OBJECT_IDS
#include "maps/products/nearest_ids.shared.h"
#include "maps/filters/pcf.glsl"
