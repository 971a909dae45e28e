// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/edges/vectors/tables.hpp"

#include <cstdint>

/// Inside volumes/ only.
namespace penumbra::volumes {

/// Input of count_to_corner, which returns the number of triangles that the segment from p to the light's lower left
/// corner meets. With `one_will_do`, for view samples whose edges do not change the count, stops at one.
struct CornerInput {
  const LightGrid& grid;
  const WideTriangleTree& tree;
  const TriangleTable& triangles;
  const ClusterSample& at;
  bool one_will_do;
  std::uint32_t light_plane;  ///< index of the light's plane; triangles in it are not between p and the light
};
std::uint32_t count_to_corner(const CornerInput& input, Open& open);

}  // namespace penumbra::volumes
