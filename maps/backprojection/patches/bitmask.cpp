// SPDX-License-Identifier: Apache-2.0
// Keeps the light samples hidden by texels as bits: Schwarz and Stamminger 2007, "Bitmask soft shadows"; 2008, "Quality
// scalability of soft shadow mapping" (rect, level). Departures: bits are the light samples of the command line, of any
// number and pattern, and are decided one by one in place of look-up tables; quads are two triangles; the box of a
// coarse texel is around all non-empty texels of its block, not only around those nearer than the receiver, which no
// table could hold.

#include "maps/backprojection/patches/methods.hpp"

#include "maps/backprojection/patches/bitmask.comp.spv.hpp"
#include "maps/backprojection/patches/bitmask.shared.h"
#include "maps/backprojection/patches/light_sample_bands.hpp"
#include "maps/backprojection/level_options.hpp"
#include "maps/backprojection/light_table.hpp"
#include "maps/backprojection/patches/options.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/backprojection/patches/repairs.hpp"
#include "maps/backprojection/subsampled.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/products/work_counts.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

constexpr visibility::ChoiceOption kOccluder{
    "occluder",
    {{"patch", gpu::kOccluderPatch},
     {"quad", gpu::kOccluderQuad},
     {"triangle", gpu::kOccluderTriangle},
     {"rect", gpu::kOccluderRect}},
    gpu::kOccluderQuad,
    "occluder of a texel: its rectangle; a quad between four centres; the same with a triangle where only three of "
    "them hide light; on a coarse level, the rectangle around a block's non-empty texels"};
constexpr auto kBitmaskFill = fill_option(gpu::kFillNone);
constexpr visibility::IntegerOption kJoinedLayers{"layers", 1, 16, 1,
                                                  "number of layers of surfaces that a receiver searches"};
constexpr auto kBitmaskSearch = search_option(Search::mssm);

visibility::MeshVerdict bitmask_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps(
      "the surfaces that the light's centre sees; their texels decide each pair of view sample and light sample", mesh);
}

}  // namespace

visibility::MethodDescription bitmask_description(const visibility::MethodOptions& options) {
  visibility::MethodDescription description{
      .name = "bitmask",
      .family = visibility::Family::image,
      .paper = "Schwarz and Stamminger 2007",
      .output = visibility::Output::mask,
      .exact_for =
          "nothing; in the limit of large maps every pair of view sample and light sample whose occluders the "
          "light's centre sees",
      .lights = visibility::kPlanarLights,
      .on_request = true,
      .options = compared_map_option_descriptions(),
      .verdict_on = bitmask_verdict,
      .repairs = bitmask_repairs};
  for (const auto& option : {kOccluder.description(), kBitmaskFill.description(), kJoinedLayers.description(),
                             kMapLevel.description(), kTexelBudget.description(), kBlendLevels.description(),
                             kBitmaskSearch.description(), kSubsample.description(), kSubsampleBy.description()}) {
    description.options.push_back(option);
  }
  std::ranges::copy(window_fit_descriptions(), std::back_inserter(description.options));
  if (visibility::parse_options(description, options)[kSubsample] > 1) description.output = visibility::Output::scalar;
  return description;
}

std::unique_ptr<visibility::Method> make_bitmask(const render::Device& device,
                                                 const visibility::MethodOptions& options) {
  MapRecipe recipe{
      .description = bitmask_description(), .look_up_name = "bitmask look-up", .look_up = shaders::kBitmaskComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  const Search search = parsed[kBitmaskSearch];
  const LevelChoice levels = level_choice(parsed);
  const gpu::BitmaskPush push{parsed[kJoinedLayers], levels.level, levels.budget, levels.blend ? 1u : 0u};
  const std::uint32_t occluder = parsed[kOccluder];
  const bool has_patches = occluder == gpu::kOccluderPatch || occluder == gpu::kOccluderRect;
  recipe.constants = {occluder, has_patches ? parsed[kBitmaskFill] : gpu::kFillNone, search == Search::none ? 0u : 1u,
                      levels.levels()};
  recipe.whole_light = true;
  recipe.group_a_receiver = true;
  recipe.layers.count = push.layers + (parsed[kDepth] == DepthUse::first ? 0 : 1);
  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(std::make_unique<LightTable>(device));
  recipe.products.push_back(std::make_unique<LightSampleBands>(device));
  recipe.products.push_back(
      std::make_unique<DepthPyramid>(device, search == Search::none ? PyramidKind::hsm : pyramid_of(search)));
  recipe.products.push_back(make_level_maps(device, levels));
  recipe.products.push_back(std::make_unique<WorkCounts>(device, std::vector<std::string>{"occludersAsked"}));
  recipe.push_words = sizeof(push) / sizeof(std::uint32_t);
  recipe.push = [push](const visibility::Light&) { return push_words(push); };
  return subsampled(device, make_map_method(device, std::move(recipe), options), parsed, options);
}

}  // namespace penumbra::maps
