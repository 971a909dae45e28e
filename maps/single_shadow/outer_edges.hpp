#pragma once

#include "maps/host/light_basis.hpp"
#include "maps/single_shadow/outer_map.shared.h"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra::maps {

/// What stands beside a silhouette edge: the sides of shadow's outer half as a light of some radius makes it, or
/// strips of one width.
enum class OuterForm : std::uint8_t {
  cones,      ///< cones of the light through the edge's ends, and the sheet that touches both (Wyman and Hansen 2003)
  smoothies,  ///< a strip along the edge, as wide everywhere as the light's centre sees it (Chan and Durand 2003)
};

/// The silhouette edges of all casters but the light's own body, as the light's centre sees them (mesh::silhouettes:
/// any soup), that are on one side of its plane: in the light's basis, z from its plane; what is nearer to the plane
/// than `near` is cut off. An edge that is seen as a point is left out.
struct OuterEdges {
  std::array<std::vector<gpu::OuterEdge>, 2> sides;  ///< where the light's normal points, and behind
  /// The mean height over the light's plane of those that are not the ground's (ground_of), weighted by their lengths
  /// as the light's centre sees them; 0 if there are none.
  double mean_height = 0;
};
OuterEdges outer_edges(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
                       OuterForm form, double near);

}  // namespace penumbra::maps
