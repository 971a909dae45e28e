// SPDX-License-Identifier: Apache-2.0
// Draws cones and sheets at silhouettes in a second map: Wyman and Hansen 2003, "Penumbra maps: approximate soft
// shadows in real-time". Departures: the light's radius is that of the disk of its area; an edge's ends have the outer
// part of their cones (outer_edges.cpp); sheets and cones are intersected at texels' centres exactly, whatever
// triangles cover them.

#include "maps/single_shadow/methods.hpp"

#include "maps/single_shadow/options.hpp"
#include "maps/single_shadow/outer_look_up.comp.spv.hpp"
#include "maps/single_shadow/outer_look_up.shared.h"
#include "maps/single_shadow/outer_recipe.hpp"
#include "maps/single_shadow/descriptions.hpp"

#include <utility>

namespace penumbra::maps {
namespace {

constexpr auto kLinearFilter =
    visibility::ChoiceOption<bool, 2>{"filter",
                                      {{"nearest", false}, {"linear", true}},
                                      true,
                                      "V from a view sample's own texel, or interpolated between the four nearest"};

}  // namespace

std::vector<visibility::OptionDescription> outer_options(std::uint32_t falloff) {
  std::vector<visibility::OptionDescription> options = compared_map_option_descriptions();
  options.push_back(falloff_option(falloff).description());
  options.push_back(kLinearFilter.description());
  return options;
}

MapRecipe outer_recipe(const render::Device& device, visibility::MethodDescription description,
                       const visibility::ParsedOptions& parsed, const OuterMap::Options& options) {
  MapRecipe recipe{.description = std::move(description),
                   .look_up_name = "outer penumbra look-up",
                   .look_up = shaders::kOuterLookUpComp};
  recipe.products.push_back(std::make_unique<OuterMap>(device, options));
  const gpu::OuterLookUpPush push{parsed[falloff_option(gpu::kFalloffCubic)], parsed[kLinearFilter] ? 1U : 0U,
                                  options.form == OuterForm::smoothies ? 1U : 0U};
  recipe.push_words = sizeof(push) / sizeof(std::uint32_t);
  recipe.push = [push](const visibility::Light&) { return push_words(push); };
  return recipe;
}

visibility::MethodDescription penumbra_map_description() {
  return single_shadow_description({.name = "penumbra-map",
                                    .paper = "Wyman and Hansen 2003",
                                    .exact_for = "nothing; its umbra is the whole hard shadow",
                                    .options = outer_options(gpu::kFalloffCubic),
                                    .verdict_on = outer_verdict,
                                    .repairs = single_shadow_repairs});
}

std::unique_ptr<visibility::Method> make_penumbra_map(const render::Device& device,
                                                      const visibility::MethodOptions& options) {
  visibility::MethodDescription description = penumbra_map_description();
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  return make_map_method(device,
                         outer_recipe(device, std::move(description), parsed,
                                      {.form = OuterForm::cones, .rasteriser = parsed[kRasteriser]}),
                         options);
}

}  // namespace penumbra::maps
