// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/light_basis.hpp"
#include "maps/single_shadow/outer_map.shared.h"
#include "visibility/light_samples.hpp"
#include "visibility/scene_floats.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra::maps {

/// Shape beside a silhouette edge: the outer half of the penumbra of a light of some radius, or strips of one width.
enum class OuterForm : std::uint8_t {
  cones,      ///< cones of the light through the edge's ends, and the sheet that touches both (Wyman and Hansen 2003)
  smoothies,  ///< a strip along the edge, of the same width everywhere as seen from the light's centre (Chan and Durand
              ///< 2003)
};

/// Silhouette edges of all casters but the light's own body, as seen from the light's centre (mesh::silhouette_edges,
/// for any triangles), on one side of its plane: in the light's basis, with z the distance from its plane. Parts nearer
/// to the plane than `near` are cut off. An edge seen as a point is left out.
struct OuterEdges {
  std::array<std::vector<gpu::OuterEdge>, 2> sides;  ///< where the light's normal points, and behind
  /// Mean height over the light's plane of the edges that do not belong to the ground (ground_of), weighted by their
  /// lengths as seen from the light's centre; 0 if there are none.
  double mean_height = 0;
};
OuterEdges outer_edges(const visibility::SceneFloats& scene, const visibility::Light& light, const LightBasis& basis,
                       OuterForm form, double near);

}  // namespace penumbra::maps
