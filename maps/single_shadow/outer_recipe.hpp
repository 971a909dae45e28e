// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "maps/single_shadow/outer_map.hpp"

namespace penumbra::maps {

/// Options of methods that look up a second map (OuterMap), and their recipe.
std::vector<visibility::OptionDescription> outer_options(std::uint32_t falloff);
MapRecipe outer_recipe(const render::Device& device, visibility::MethodDescription description,
                       const visibility::ParsedOptions& parsed, const OuterMap::Options& options);

}  // namespace penumbra::maps
