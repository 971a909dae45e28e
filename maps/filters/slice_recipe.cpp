// SPDX-License-Identifier: Apache-2.0
// Assembles `convolution` and `occlusion-textures` (Soler and Sillion 1998; Eisemann and Décoret 2006): options and
// products common to both.

#include "maps/filters/slice_recipe.hpp"

#include "maps/filters/horizon.hpp"
#include "maps/filters/occlusion_textures.comp.spv.hpp"
#include "maps/filters/occlusion_textures.shared.h"
#include "maps/products/light_shape.hpp"
#include "maps/products/map_frame.hpp"
#include "maps/products/nearest_caster.hpp"

#include <utility>

namespace penumbra::maps {
MapRecipe slice_recipe(const render::Device& device, visibility::MethodDescription description,
                       const SliceOptions& options, PrefilterKind filter) {
  MapRecipe recipe{.description = std::move(description),
                   .look_up_name = "slices look-up",
                   .look_up = shaders::kOcclusionTexturesComp};
  std::vector<PrefilterFunction> bits;
  for (std::uint32_t k = 0; k < options.count; ++k) {
    bits.push_back({.kind = gpu::kBit, .a = static_cast<float>(k), .digits = 0});
  }
  auto nearest = std::make_unique<NearestCaster>(device);
  auto frame = std::make_unique<MapFrame>(device);
  auto slices = std::make_unique<Slices>(device, options);
  auto prefilter = std::make_unique<Prefilter>(
      device, PrefilterOptions{.kind = filter, .functions = std::move(bits), .of_bits = true},
      Prefilter::Sources{.nearest = nearest.get(), .frame = frame.get(), .bits = slices.get()});
  recipe.products.push_back(std::move(nearest));
  recipe.products.push_back(std::move(frame));
  recipe.products.push_back(std::move(slices));
  recipe.products.push_back(std::move(prefilter));
  recipe.products.push_back(
      std::make_unique<LightPattern>(device, std::initializer_list<std::uint32_t>{kHorizonSamples}));
  // Planes are assumed to be no nearer to the light than the radius of the disk of its area, as for pcss's windows.
  recipe.beside = [](const visibility::Light& light, const LightBasis& basis) {
    return half_extent(light, basis) / half_width(light);
  };
  recipe.push_words = sizeof(gpu::OcclusionPush) / sizeof(std::uint32_t);
  recipe.push = [](const visibility::Light& /*light*/) { return push_words(gpu::OcclusionPush{kHorizonSamples}); };
  return recipe;
}

}  // namespace penumbra::maps
