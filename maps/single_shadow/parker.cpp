// SPDX-License-Identifier: Apache-2.0
// Computes soft edges around a hard shadow: Parker, Shirley and Smits 1998, "Single sample soft shadows". Departure: in
// the paper a ray gives the distance at which it passes each object; here these distances come from texels of the
// light's map, which are the visible parts of the objects.

#include "maps/single_shadow/methods.hpp"

#include "maps/single_shadow/options.hpp"
#include "maps/single_shadow/parker.comp.spv.hpp"
#include "maps/single_shadow/descriptions.hpp"
#include "maps/single_shadow/search_recipe.hpp"

#include <utility>

namespace penumbra::maps {
visibility::MethodDescription parker_description() {
  visibility::MethodDescription description =
      single_shadow_description({.name = "parker",
                                 .paper = "Parker et al. 1998",
                                 .exact_for = "nothing; its umbra is the whole hard shadow",
                                 .options = compared_map_option_descriptions(),
                                 .verdict_on = outer_verdict,
                                 .repairs = searched_shadow_repairs});
  description.warning = cut_search_warning;
  for (const auto& option : {kSearchRadius.description(), falloff_option(gpu::kFalloffCubic).description()}) {
    description.options.push_back(option);
  }
  return description;
}

std::unique_ptr<visibility::Method> make_parker(const render::Device& device,
                                                const visibility::MethodOptions& options) {
  visibility::MethodDescription description = parker_description();
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  return make_map_method(device,
                         search_recipe(device,
                                       {.description = std::move(description),
                                        .falloff = gpu::kFalloffCubic,
                                        .look_up_name = "soft edges look-up",
                                        .look_up = shaders::kParkerComp},
                                       parsed, false),
                         options);
}

}  // namespace penumbra::maps
