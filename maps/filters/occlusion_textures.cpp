// SPDX-License-Identifier: Apache-2.0
// Multiplies the visible fractions of filtered slices: Eisemann and Décoret 2006, "Plausible image based soft shadows
// using occlusion textures" (Eisemann et al. 2009, section 5.2.5). Departures: surfaces are sorted into slices by one
// raster pass from the light's centre, and box means come from summed areas in integers unless the option `filter`
// selects another scheme.

#include "maps/filters/methods.hpp"

#include "maps/filters/slice_recipe.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/filters/repairs.hpp"

namespace penumbra::maps {
namespace {

constexpr visibility::IntegerOption kSlices{"slices", 1, gpu::kMostSlices, 8, "slices parallel to the light"};

visibility::MeshVerdict occlusion_textures_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("slices, each assumed to be flat, whose visible fractions are multiplied in place of a union",
                        mesh);
}

}  // namespace

visibility::MethodDescription occlusion_textures_description() {
  visibility::MethodDescription description{.name = "occlusion-textures",
                                            .family = visibility::Family::image,
                                            .paper = "Eisemann and Décoret 2006",
                                            .output = visibility::Output::scalar,
                                            .exact_for =
                                                "nothing; in the limit of large maps, one flat blocker parallel to a "
                                                "rectangle light in the far plane of a slice",
                                            .lights = visibility::kPlanarLights,
                                            .textures = false,
                                            .options = single_map_option_descriptions(),
                                            .verdict_on = occlusion_textures_verdict,
                                            .repairs = slice_repairs};
  description.options.push_back(kSlices.description());
  description.options.push_back(kSliceFilter.description());
  return description;
}

std::unique_ptr<visibility::Method> make_occlusion_textures(const render::Device& device,
                                                            const visibility::MethodOptions& options) {
  const visibility::ParsedOptions parsed = visibility::parse_options(occlusion_textures_description(), options);
  const SliceOptions slices{.rule = SliceRule::equal,
                            .count = parsed[kSlices],
                            .rasteriser = parsed[kRasteriser],
                            .depth = parsed[kDepth],
                            .bias = parsed[kBias]};
  return make_map_method(device, slice_recipe(device, occlusion_textures_description(), slices, parsed[kSliceFilter]),
                         options);
}

}  // namespace penumbra::maps
