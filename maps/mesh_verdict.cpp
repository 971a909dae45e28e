#include "maps/mesh_verdict.hpp"

namespace penumbra::maps {

visibility::MeshVerdict judge_for_maps(std::string_view sentence, const mesh::Diagnosis& mesh) {
  return {visibility::Verdict::approximate,
          visibility::reason_with(
              sentence, mesh,
              {{mesh.needles.count, "needles may be thinner than a texel, and are then hit or missed"},
               {mesh.boundary_loops, "boundaries: a hole or gap narrower than a texel closes or widens"},
               {mesh.t_junctions.count, "T-junctions may open cracks a texel wide"},
               {mesh.zero_area_triangles.count, "triangles without area cast nothing, as they should"}})};
}

}  // namespace penumbra::maps
