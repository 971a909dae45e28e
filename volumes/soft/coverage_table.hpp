// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/radial_coverage.hpp"
#include "volumes/wedges/texture_weights.hpp"

#include <glm/vec2.hpp>

#include <vector>

namespace penumbra::volumes {

/// Returns the table that coverage_table.glsl uses: for each pair of the light's 1024 points, the share of the light
/// beyond the edge between them, for a cone that does not pass the direction at which fans begin. 8 MiB.
///
/// Error: ends of edges move by at most `kTableReach`, together where edges meet, so closed loops stay closed. While an
/// edge of length s moves to one of length s', it sweeps at most kTableReach (s + s') / 2. V is off by no more than the
/// sum of |k| times this area over all edges, divided by |L| (docs/soft-volume.md).
std::vector<double> coverage_table(const LightOutline& outline, const TextureWeights* texture);

/// Half the diagonal of a cell of the rectangle's points: √2/31 = 0.0456. For the disk's points, half a step outward
/// and half a step around it: √((1/31)² + (2 sin(π/128))²) = 0.0588.
inline constexpr double kRectangleTableReach = 0.0457, kDiskTableReach = 0.0589;

}  // namespace penumbra::volumes
