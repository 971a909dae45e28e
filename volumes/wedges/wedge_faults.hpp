#pragma once

#include "volumes/wedges/penumbra_wedge.hpp"

#include <span>
#include <vector>

/// Wedges that are wrong on purpose, each by one mistake that is easily made: validation must catch them.
namespace penumbra::volumes {

enum class Fault {
  endpoint_not_moved = 1,  ///< all four planes from the edge as it is: where it points at the light no plane touches it
  wrong_light_vertex,      ///< a side plane through the corner of the light that leaves the most beyond
  front_back_swapped,      ///< front and back plane look the wrong way
  rounded_inward,          ///< coefficients as floats, and d rounded towards the inside
  near_plane_clipped,      ///< one more plane, across the wedge a little below the edge
  split_missing,           ///< where the construction splits, four planes of the whole edge all the same; in a scene
                           ///< where it never does, the longest edge is split and its second half forgotten
};

/// As build_wedges(…, Construction::original), but built with the fault and without proof. Planes that can be proved
/// are; only what the fault spoils is wrong.
std::vector<Wedge> build_faulty_wedges(std::span<const WedgeEdge> edges, const LightHull& light, Fault fault);

}  // namespace penumbra::volumes
