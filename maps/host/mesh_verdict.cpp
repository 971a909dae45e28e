// SPDX-License-Identifier: Apache-2.0
// Gives the verdict of depth maps on a mesh with defects: always "approximate". Its reasons are the defects that a map
// shows wrongly because they are smaller than a texel. Not from a paper; docs/defects.md has pictures.

#include "maps/host/mesh_verdict.hpp"

namespace penumbra::maps {

visibility::MeshVerdict judge_for_maps(std::string_view sentence, const mesh::Diagnosis& mesh) {
  return {
      visibility::Verdict::approximate,
      visibility::reason_with(
          sentence, mesh,
          {{mesh.needles.count, "needles, which are hit or missed where they are thinner than a texel"},
           {mesh.boundary_loops, "open boundaries, whose holes close or widen where they are narrower than a texel"},
           {mesh.t_junctions.count, "T-junctions, whose hairline cracks may show as single texels"},
           {mesh.zero_area_triangles.count, "triangles without area, which cast no shadow"}})};
}

}  // namespace penumbra::maps
