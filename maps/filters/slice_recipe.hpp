// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "maps/host/map_method.hpp"
#include "maps/products/prefilter.hpp"
#include "maps/products/slices.hpp"

namespace penumbra::maps {

/// Option of both methods that filter slices.
inline constexpr visibility::ChoiceOption kSliceFilter{
    "filter",
    {{"sat", PrefilterKind::table}, {"mip", PrefilterKind::pyramid}, {"n-buffer", PrefilterKind::windows}},
    PrefilterKind::table,
    "table from which means over windows are read: summed areas in integers, mip levels, overlapping squares"};

/// Returns the recipe: light-space slices, each filtered by the light seen through its plane, and the product of their
/// visible fractions (occlusion_textures.comp).
MapRecipe slice_recipe(const render::Device& device, visibility::MethodDescription description,
                       const SliceOptions& slices, PrefilterKind filter);

}  // namespace penumbra::maps
