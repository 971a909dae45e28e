// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "maps/host/map_view.shared.h"
#include "render/both.glsl"
#include "maps/host/map_depth.glsl"

// Depth is linear in the distance along the face's axis: as a float it has the same relative precision (2^-24)
// everywhere, however small the near distance is. The usual depth 1 - near / w would lose a factor w / near of
// precision.

PUSH_CONSTANTS Push { CasterPush face; };

void main() { gl_FragDepth = offset_map_depth(face, gl_FragCoord); }
