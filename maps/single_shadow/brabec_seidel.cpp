// SPDX-License-Identifier: Apache-2.0
// Searches a map for the nearest border of the hard shadow: Brabec and Seidel 2002, "Single sample soft shadows using
// depth maps", as described in the course notes of Eisemann et al. (2009, section 5.2.1). Departures: the half penumbra
// on either side is that of a disk with the light's area, where the paper scales by hand; distances are measured to a
// texel's border.

#include "maps/single_shadow/methods.hpp"

#include "maps/host/mesh_verdict.hpp"
#include "maps/products/nearest_ids.hpp"
#include "maps/single_shadow/brabec_seidel.comp.spv.hpp"
#include "maps/single_shadow/options.hpp"
#include "maps/single_shadow/descriptions.hpp"
#include "maps/single_shadow/search_recipe.hpp"

#include <utility>

namespace penumbra::maps {
namespace {

constexpr auto kIds = visibility::flag_option(
    "ids", true,
    "on: surfaces of a view sample's own object do not shade it, so that no bias is needed; off: depths alone decide");

visibility::MeshVerdict brabec_seidel_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("penumbrae around the hard shadow of the light's centre, determined by the nearest texel alone",
                        mesh);
}

}  // namespace

visibility::MethodDescription brabec_seidel_description() {
  visibility::MethodDescription description = single_shadow_description({.name = "brabec-seidel",
                                                                         .paper = "Brabec and Seidel 2002",
                                                                         .exact_for = "nothing",
                                                                         .options = compared_map_option_descriptions(),
                                                                         .verdict_on = brabec_seidel_verdict,
                                                                         .repairs = searched_shadow_repairs});
  description.warning = cut_search_warning;
  for (const auto& option :
       {kSearchRadius.description(), falloff_option(gpu::kFalloffLinear).description(), kIds.description()}) {
    description.options.push_back(option);
  }
  return description;
}

std::unique_ptr<visibility::Method> make_brabec_seidel(const render::Device& device,
                                                       const visibility::MethodOptions& options) {
  visibility::MethodDescription description = brabec_seidel_description();
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  MapRecipe recipe = search_recipe(device,
                                   {.description = std::move(description),
                                    .falloff = gpu::kFalloffLinear,
                                    .look_up_name = "single sample look-up",
                                    .look_up = shaders::kBrabecSeidelComp},
                                   parsed, parsed[kIds]);
  recipe.products.push_back(std::make_unique<NearestIds>(device, parsed[kRasteriser], IdsOf::objects));
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
