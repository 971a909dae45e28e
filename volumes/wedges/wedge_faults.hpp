// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volumes/wedges/penumbra_wedge.hpp"

#include <span>
#include <vector>

/// Wedges with deliberate faults, one common mistake each: validation must detect them.
namespace penumbra::volumes {

enum class Fault {
  endpoint_not_moved = 1,  ///< all four planes are of the unmoved edge: where the edge points at the light, no plane
                           ///< touches the light
  wrong_light_vertex,      ///< a side plane contains the corner of the light that leaves the most corners beyond
  front_back_swapped,      ///< front and back plane face the opposite direction
  rounded_inward,          ///< coefficients as floats, with d rounded towards the inside
  near_plane_clipped,      ///< one more plane, across the wedge a little below the edge
  split_missing,           ///< where the construction splits, the whole edge has four planes instead; in a scene
                           ///< without splits, the longest edge is split and its second half omitted
};

/// Returns the wedges of build_wedges(…, Construction::original), but built with the fault and without proof. Every
/// plane that can be proved is proved; only the planes affected by the fault are wrong.
std::vector<Wedge> build_faulty_wedges(std::span<const WedgeEdge> edges, const LightHull& light, Fault fault);

}  // namespace penumbra::volumes
