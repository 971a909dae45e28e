// SPDX-License-Identifier: Apache-2.0
// Computes the mean of a blocker picture over the light's image: Soler and Sillion 1998, "Fast calculation of soft
// shadow textures using convolution". Departures: the mean over the light's image is computed for each view sample, by
// summed areas, instead of convolving a picture for one receiver at a time; blockers are all casters except the ground
// (ground_of), where the paper takes them as input.

#include "maps/filters/methods.hpp"

#include "maps/filters/slice_recipe.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/filters/repairs.hpp"

namespace penumbra::maps {
namespace {

visibility::MeshVerdict convolution_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("all blockers moved to one plane at their mean height, whatever their own heights", mesh);
}

}  // namespace

visibility::MethodDescription convolution_description() {
  visibility::MethodDescription description{
      .name = "convolution",
      .family = visibility::Family::image,
      .paper = "Soler and Sillion 1998",
      .output = visibility::Output::scalar,
      .exact_for = "nothing; in the limit of large maps, blockers in one plane parallel to a rectangle light",
      .lights = visibility::kPlanarLights,
      .textures = false,
      .options = single_map_option_descriptions(),
      .verdict_on = convolution_verdict,
      .repairs = slice_repairs};
  description.options.push_back(kSliceFilter.description());
  return description;
}

std::unique_ptr<visibility::Method> make_convolution(const render::Device& device,
                                                     const visibility::MethodOptions& options) {
  const visibility::ParsedOptions parsed = visibility::parse_options(convolution_description(), options);
  const SliceOptions slices{.rule = SliceRule::one_plane,
                            .count = 1,
                            .rasteriser = parsed[kRasteriser],
                            .depth = parsed[kDepth],
                            .bias = parsed[kBias]};
  return make_map_method(device, slice_recipe(device, convolution_description(), slices, parsed[kSliceFilter]),
                         options);
}

}  // namespace penumbra::maps
