// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "visibility/mesh_verdict.hpp"

#include <string_view>

/// Verdict of depth maps on a mesh. Maps accept every mesh that can be rasterised, from either side: windings, doubled
/// and opposite faces, non-manifold edges and self-intersections have no effect. Features smaller than a texel have an
/// effect.
namespace penumbra::maps {

/// Returns the verdict "approximate", with `sentence` and the properties of this mesh that maps represent wrongly as
/// reasons.
visibility::MeshVerdict judge_for_maps(std::string_view sentence, const mesh::Diagnosis& mesh);

}  // namespace penumbra::maps
