#pragma once

#include "volumes/edges/vectors/tables.hpp"

#include <cstdint>

/// Inside volumes/ only.
namespace penumbra::volumes {

/// How many triangles the segment from p to the light's lower left corner meets. One is as good as many where no edge
/// changes the count (`one_will_do`).
struct CornerInput {
  const LightGrid& grid;
  const WideTriangleTree& tree;
  const TriangleTable& triangles;
  const ClusterSample& at;
  bool one_will_do;
  std::uint32_t light_plane;  ///< its number: triangles in it are not between p and the light
};
std::uint32_t count_to_corner(const CornerInput& input, Open& open);

}  // namespace penumbra::volumes
