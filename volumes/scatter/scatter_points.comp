// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "engines/device/mask.shared.h"
#include "volumes/edges/device/edge_scatter.glsl"

// Variant of scatter_edges.comp for arbitrary light samples: samples of similar height form a row (point_rows.cpp), and
// an edge changes a row from one light sample on. The selection of these light samples differs: docs/edge-scatter.md,
// "Light samples anywhere".

#include "volumes/scatter/scatter_view_samples.glsl"
#include "volumes/scatter/scatter_one.glsl"
#include "volumes/scatter/scatter_points.glsl"
#include "volumes/scatter/scatter_group.glsl"
#include "volumes/scatter/scatter_corner.glsl"
#include "volumes/scatter/scatter_points_sum.glsl"
#include "volumes/scatter/scatter_main.glsl"
