// SPDX-License-Identifier: Apache-2.0
// Draws strips beside silhouettes in a second map: Chan and Durand 2003, "Rendering fake soft shadows with smoothies".
// Departures: where the paper has one width for all, chosen by hand, the default is the correct width for an edge at
// the mean height of the silhouettes; an edge's ends have quarters of disks in place of corners between two edges.

#include "maps/single_shadow/methods.hpp"

#include "maps/single_shadow/outer_recipe.hpp"
#include "maps/single_shadow/descriptions.hpp"
#include "maps/single_shadow/options.hpp"

#include <utility>

namespace penumbra::maps {
namespace {

constexpr visibility::RealOption kWidth{"width", 0, 1e6, 0,
                                        "width of smoothies at distance 1 from the light's plane; 0: the light's "
                                        "radius over the mean height of the silhouettes that are not the ground's"};

}  // namespace

visibility::MethodDescription smoothies_description() {
  visibility::MethodDescription description =
      single_shadow_description({.name = "smoothies",
                                 .paper = "Chan and Durand 2003",
                                 .exact_for = "nothing; its umbra is the whole hard shadow",
                                 .options = outer_options(gpu::kFalloffCubic),
                                 .verdict_on = outer_verdict,
                                 .repairs = single_shadow_repairs});
  description.options.push_back(kWidth.description());
  return description;
}

std::unique_ptr<visibility::Method> make_smoothies(const render::Device& device,
                                                   const visibility::MethodOptions& options) {
  visibility::MethodDescription description = smoothies_description();
  const visibility::ParsedOptions parsed = visibility::parse_options(description, options);
  return make_map_method(
      device,
      outer_recipe(device, std::move(description), parsed,
                   {.form = OuterForm::smoothies, .width = parsed[kWidth], .rasteriser = parsed[kRasteriser]}),
      options);
}

}  // namespace penumbra::maps
