// SPDX-License-Identifier: Apache-2.0
// Projects several layers of one map back onto the light: Bavoil, Callahan and Silva 2006, "Robust soft shadow mapping
// with depth peeling". Departures: those of backproject; the midpoint of the last layer needs the layer behind, which
// is also peeled; a block is as wide as the square root of the ratio of a kernel's texels to the permitted ones,
// instead of the ratio.

#include "maps/backprojection/patches/methods.hpp"

#include "maps/backprojection/patches/backproject_peel.comp.spv.hpp"
#include "maps/backprojection/patches/backproject_peel_sort.comp.spv.hpp"
#include "maps/backprojection/patches/backproject_peel.shared.h"
#include "maps/backprojection/light_table.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/backprojection/patches/repairs.hpp"
#include "maps/backprojection/subsampled.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "maps/products/nearest_caster.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace penumbra::maps {
namespace {

constexpr visibility::IntegerOption kPeeledLayers{"layers", 1, 16, 3,
                                                  "number of layers of surfaces that a receiver searches"};
constexpr visibility::IntegerOption kSamples{
    "samples", 0, 1048576, 121,
    "largest number of texels that a receiver reads, evenly spread over its kernel; 0: all"};
constexpr visibility::ChoiceOption<std::uint32_t, 2> kSelect{
    "select",
    {{"contribution", 0u}, {"deepest", 1u}},
    0u,
    "surface of a texel in front of the receiver that counts: the deepest that hides light, or the deepest"};
constexpr auto kPeelDepth = depth_option(DepthUse::midpoint);

visibility::MeshVerdict backproject_peel_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("the surfaces nearest to the light's centre, as patches whose shadows are added up", mesh);
}

}  // namespace

visibility::MethodDescription backproject_peel_description() {
  visibility::MethodDescription description{
      .name = "backproject-peel",
      .family = visibility::Family::image,
      .paper = "Bavoil et al. 2006",
      .output = visibility::Output::scalar,
      .exact_for =
          "nothing; in the limit of large maps and all samples, where all that shades lies in one plane "
          "parallel to the light",
      .lights = visibility::kPlanarLights,
      .options = compared_map_option_descriptions(DepthUse::midpoint),
      .verdict_on = backproject_peel_verdict,
      .repairs = peel_repairs};
  description.options.push_back(kPeeledLayers.description());
  description.options.push_back(kSamples.description());
  description.options.push_back(kSelect.description());
  description.options.push_back(kSubsample.description());
  description.options.push_back(kSubsampleBy.description());
  std::ranges::copy(window_fit_descriptions(), std::back_inserter(description.options));
  return description;
}

std::unique_ptr<visibility::Method> make_backproject_peel(const render::Device& device,
                                                          const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = backproject_peel_description(),
                   .look_up_name = "backproject-peel look-up",
                   .look_up = shaders::kBackprojectPeelComp,
                   .sort_out = shaders::kBackprojectPeelSortComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  const gpu::PeelLookPush push{parsed[kPeeledLayers], parsed[kSamples], parsed[kSelect]};
  recipe.whole_light = true;
  recipe.group_a_receiver = true;
  recipe.layers.count = push.layers + (parsed[kPeelDepth] == DepthUse::first ? 0 : 1);
  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(std::make_unique<LightTable>(device));
  recipe.products.push_back(std::make_unique<DepthPyramid>(device, PyramidKind::hsm));
  recipe.push_words = sizeof(push) / sizeof(std::uint32_t);
  recipe.push = [push](const visibility::Light&) { return push_words(push); };
  return subsampled(device, make_map_method(device, std::move(recipe), options), parsed, options);
}

}  // namespace penumbra::maps
