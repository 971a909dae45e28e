// SPDX-License-Identifier: Apache-2.0
// Computes V as the mean of hard shadows from points of the light: Heckbert and Herf 1997, "Simulating soft shadows
// with graphics hardware". Departures: the paper draws the blended shadow into a texture for each receiver polygon;
// here each light sample has a shadow map (Williams 1978), looked up at the view samples, and the result is kept as a
// separate bit.

#include "maps/sampling/methods.hpp"

#include "maps/sampling/accumulate.comp.spv.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/sampling/repairs.hpp"

namespace penumbra::maps {
namespace {

visibility::MeshVerdict accumulate_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("each pair within half a texel of a shadow's edge may be wrong", mesh);
}

}  // namespace

visibility::MethodDescription accumulate_description() {
  return {.name = "accumulate",
          .family = visibility::Family::image,
          .paper = "Heckbert and Herf 1997",
          .output = visibility::Output::mask,
          .exact_for =
              "nothing; in the limit of large maps every pair of view sample and light sample, any soup of "
              "triangles that can be rasterised",
          .lights = visibility::kPlanarLights,
          .options = map_option_descriptions(),
          .verdict_on = accumulate_verdict,
          .repairs = sampling_repairs};
}

std::unique_ptr<visibility::Method> make_accumulate(const render::Device& device,
                                                    const visibility::MethodOptions& options) {
  return make_map_method(device,
                         {.description = accumulate_description(),
                          .points = MapPoints::light_samples,
                          .look_up_name = "accumulate look-up",
                          .look_up = shaders::kAccumulateComp},
                         options);
}

}  // namespace penumbra::maps
