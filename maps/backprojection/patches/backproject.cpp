// SPDX-License-Identifier: Apache-2.0
// Projects texels of one map back onto the light: Guennebaud, Barthe and Paulin 2006, "Real-time soft shadow mapping by
// backprojection". Departures: each texel is compared with the receiver's plane in its own direction (taps.glsl); up to
// five faces replace one perspective image; parts of the light are added as integers; lights have any planar shape
// (light_table.hpp); several layers may be used, as by Bavoil et al. 2006.

#include "maps/backprojection/patches/methods.hpp"

#include "maps/backprojection/patches/backproject.comp.spv.hpp"
#include "maps/backprojection/patches/backproject_sort.comp.spv.hpp"
#include "maps/backprojection/patches/backproject.shared.h"
#include "maps/backprojection/level_options.hpp"
#include "maps/backprojection/light_table.hpp"
#include "maps/backprojection/patches/options.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/backprojection/patches/repairs.hpp"
#include "maps/backprojection/subsampled.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/products/nearest_caster.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace penumbra::maps {
namespace {

constexpr auto kPatchFill = fill_option(gpu::kFillEdges);
constexpr visibility::ChoiceOption kForm{"form",
                                         {{"patch", gpu::kFormPatch}, {"sphere", gpu::kFormSphere}},
                                         gpu::kFormPatch,
                                         "form of a patch: a rectangle on the light, or a bounding sphere in front of "
                                         "the light (a disk of its area, or a sphere; without fill)"};
constexpr visibility::IntegerOption kDeepestLayers{
    "layers", 1, 16, 1,
    "number of layers of surfaces that a receiver searches; the deepest layer that hides some of the light counts"};
constexpr auto kPatchSearch = search_option(Search::hsm);

visibility::MeshVerdict backproject_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("the surfaces that the light's centre sees, as patches whose shadows are added up", mesh);
}

}  // namespace

visibility::MethodDescription backproject_description(const visibility::MethodOptions& options) {
  visibility::MethodDescription description{
      .name = "backproject",
      .family = visibility::Family::image,
      .paper = "Guennebaud et al. 2006",
      .output = visibility::Output::scalar,
      .exact_for =
          "nothing; in the limit of large maps, scenes in which all casters lie in one plane parallel to the light",
      .lights = visibility::kPlanarLights,
      .options = compared_map_option_descriptions(),
      .verdict_on = backproject_verdict,
      .repairs = backproject_repairs};
  description.options.push_back(kPatchFill.description());
  description.options.push_back(kForm.description());
  description.options.push_back(kDeepestLayers.description());
  for (const auto& option : {kMapLevel.description(), kTexelBudget.description(), kBlendLevels.description()})
    description.options.push_back(option);
  description.options.push_back(kPatchSearch.description());
  description.options.push_back(kSubsample.description());
  description.options.push_back(kSubsampleBy.description());
  std::ranges::copy(window_fit_descriptions(), std::back_inserter(description.options));
  if (visibility::parse_options(description, options)[kForm] == gpu::kFormSphere) {
    description.lights = visibility::kPlanarLights | visibility::kBodies;
    description.textures = false;  // a cap of directions has uniform brightness
  }
  return description;
}

std::unique_ptr<visibility::Method> make_backproject(const render::Device& device,
                                                     const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = backproject_description(options),
                   .look_up_name = "backproject look-up",
                   .look_up = shaders::kBackprojectComp,
                   .sort_out = shaders::kBackprojectSortComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  recipe.whole_light = true;
  recipe.group_a_receiver = true;
  recipe.layers.count = parsed[kDeepestLayers] + (parsed[kDepth] == DepthUse::first ? 0 : 1);
  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(std::make_unique<LightTable>(device));
  const Search search = parsed[kPatchSearch];
  recipe.products.push_back(
      std::make_unique<DepthPyramid>(device, search == Search::none ? PyramidKind::hsm : pyramid_of(search)));
  const LevelChoice levels = level_choice(parsed);
  recipe.products.push_back(make_level_maps(device, levels));
  recipe.all_casters = parsed[kForm] == gpu::kFormSphere;
  recipe.constants = {parsed[kPatchFill], parsed[kForm], search == Search::none ? 0u : 1u, levels.levels()};
  recipe.push_words = sizeof(gpu::BackprojectPush) / sizeof(std::uint32_t);
  recipe.push = [layers = parsed[kDeepestLayers], levels](const visibility::Light& light) {
    // half_width() of a sphere is its radius: it counts with the area of the disk of its radius.
    return push_words(gpu::BackprojectPush{layers, is_body(light.kind) ? 1u : 0u, static_cast<float>(half_width(light)),
                                           levels.level, levels.budget, levels.blend ? 1u : 0u});
  };
  return subsampled(device, make_map_method(device, std::move(recipe), options), parsed, options);
}

}  // namespace penumbra::maps
