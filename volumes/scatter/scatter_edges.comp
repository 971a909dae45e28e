// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "engines/device/mask.shared.h"
#include "volumes/edges/device/edge_scatter.glsl"

// Second pass of edge scatter, a workgroup for a few neighbouring view samples (one in each lane) and a band of light
// rows: computes D, the number of triangles between p and each light sample. D at the light's lower left corner is
// counted triangle by triangle. From there D changes by ∓k_e(p), the signed multiplicity of edge e as seen from p, at
// each projected edge: up the light's left side, then along each row. Edges are scattered into a histogram [column][row] of such changes, in bytes; a running sum converts it to depths.
// Derivation, bounds and the handling of light rows that rounding leaves open: docs/edge-scatter.md.

#include "volumes/scatter/scatter_view_samples.glsl"
#include "volumes/scatter/scatter_one.glsl"
#include "volumes/scatter/scatter_rows.glsl"
#include "volumes/scatter/scatter_group.glsl"
#include "volumes/scatter/scatter_corner.glsl"
#include "volumes/scatter/scatter_sum.glsl"
#include "volumes/scatter/scatter_main.glsl"
