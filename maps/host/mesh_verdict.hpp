#pragma once

#include "visibility/mesh_verdict.hpp"

#include <string_view>

/// What depth maps make of a mesh. They take anything that can be rasterised, from either side: windings, doubled and
/// opposite faces, non-manifold edges and self-intersections change nothing. What is small against a texel does.
namespace penumbra::maps {

/// Approximate, because of `sentence` and of what there is in this mesh that maps get wrong.
visibility::MeshVerdict judge_for_maps(std::string_view sentence, const mesh::Diagnosis& mesh);

}  // namespace penumbra::maps
