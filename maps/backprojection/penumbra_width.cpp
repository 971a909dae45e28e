// SPDX-License-Identifier: Apache-2.0
// Records penumbra_width.comp: a bound of the narrowest penumbra at each view sample, used by subsampled.cpp
// (Guennebaud, Barthe and Paulin 2007 do not give the estimate).

#include "maps/backprojection/penumbra_width.hpp"

#include "maps/backprojection/light_table.hpp"
#include "maps/backprojection/penumbra_width.comp.spv.hpp"
#include "maps/host/map_method.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "maps/products/nearest_caster.hpp"

#include <utility>

namespace penumbra::maps {

std::unique_ptr<visibility::Method> make_penumbra_widths(const render::Device& device,
                                                         const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = {.name = "penumbra widths",
                                   .family = visibility::Family::image,
                                   .paper = "Guennebaud et al. 2007",
                                   .output = visibility::Output::scalar,
                                   .exact_for = "nothing",
                                   .lights = visibility::kPlanarLights | visibility::kBodies,
                                   .options = compared_map_option_descriptions()},
                   .look_up_name = "penumbra widths",
                   .look_up = shaders::kPenumbraWidthComp};
  recipe.whole_light = true;
  recipe.group_a_receiver = true;
  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(std::make_unique<LightTable>(device));
  recipe.products.push_back(std::make_unique<DepthPyramid>(device, PyramidKind::hsm));
  visibility::MethodOptions of_map;
  for (const visibility::OptionDescription& option : recipe.description.options) {
    if (const auto given = options.find(option.name); given != options.end()) of_map.insert(*given);
  }
  return make_map_method(device, std::move(recipe), of_map);
}

}  // namespace penumbra::maps
