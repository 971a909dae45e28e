#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define OBJECT_IDS
#include "maps/products/nearest_ids.shared.h"
#include "maps/filters/pcf.glsl"
