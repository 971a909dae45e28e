// Schwarz and Stamminger 2007, "Bitmask soft shadows"; 2008, "Quality scalability of soft shadow mapping" (rect,
// level). Departures: bits are the light samples of the command line, whatever their number and pattern, and are
// decided one by one in place of look-up tables; quads are two triangles; the box of a coarse texel is around what
// there is in its block and not around what is nearer than the receiver, which no table could hold.

#include "maps/backprojection/patches/methods.hpp"

#include "maps/backprojection/patches/bitmask.comp.spv.hpp"
#include "maps/backprojection/patches/bitmask.shared.h"
#include "maps/backprojection/patches/level_maps.hpp"
#include "maps/backprojection/patches/light_sample_bands.hpp"
#include "maps/backprojection/light_table.hpp"
#include "maps/backprojection/patches/options.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/backprojection/patches/repairs.hpp"
#include "maps/backprojection/subsampled.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/products/work_counts.hpp"

#include <string>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

constexpr visibility::ChoiceOption kOccluder{"occluder",
                                             {{"patch", gpu::kOccluderPatch},
                                              {"quad", gpu::kOccluderQuad},
                                              {"triangle", gpu::kOccluderTriangle},
                                              {"rect", gpu::kOccluderRect}},
                                             gpu::kOccluderQuad,
                                             "a texel's rectangle; a quad between four centres; with a triangle where "
                                             "three of them hide; of a level, the rectangle "
                                             "around what there is"};
constexpr auto kBitmaskFill = fill_option(gpu::kFillNone);
constexpr visibility::IntegerOption kJoinedLayers{"layers", 1, 16, 1, "layers of surfaces that are asked"};
constexpr visibility::IntegerOption kLevel{"level", 0, 6, 0, "blocks of 2^level texels a side are one texel"};
constexpr visibility::IntegerOption kBudget{
    "budget", 0, 1u << 28, 0,
    "texels of a face that a receiver may look at; where there are more, coarser levels stand for them; 0: no limit"};
constexpr auto kBlend =
    visibility::flag_option("blend", true, "with a budget: pass from one level to the next without steps");
constexpr auto kBitmaskSearch = search_option(Search::mssm);

visibility::MeshVerdict bitmask_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("the surfaces that the light's centre sees, each pair decided by their texels", mesh);
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
                             kLevel.description(), kBudget.description(), kBlend.description(),
                             kBitmaskSearch.description(), kSubsample.description(), kSubsampleBy.description()}) {
    description.options.push_back(option);
  }
  if (visibility::parse_options(description, options)[kSubsample] > 1) description.output = visibility::Output::scalar;
  return description;
}

std::unique_ptr<visibility::Method> make_bitmask(const render::Device& device,
                                                 const visibility::MethodOptions& options) {
  MapRecipe recipe{
      .description = bitmask_description(), .look_up_name = "bitmask look-up", .look_up = shaders::kBitmaskComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  const Search search = parsed[kBitmaskSearch];
  const gpu::BitmaskPush push{parsed[kJoinedLayers], parsed[kLevel], parsed[kBudget], parsed[kBlend] ? 1u : 0u};
  const std::uint32_t occluder = parsed[kOccluder];
  const bool has_patches = occluder == gpu::kOccluderPatch || occluder == gpu::kOccluderRect;
  recipe.constants = {occluder, has_patches ? parsed[kBitmaskFill] : gpu::kFillNone, search == Search::none ? 0u : 1u,
                      push.budget > 0  ? gpu::kLevelsByBudget
                      : push.level > 0 ? gpu::kOneLevel
                                       : gpu::kFinestLevel};
  recipe.whole_light = true;
  recipe.group_a_receiver = true;
  recipe.layers.count = push.layers + (parsed[kDepth] == DepthUse::first ? 0 : 1);
  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(std::make_unique<LightTable>(device));
  recipe.products.push_back(std::make_unique<LightSampleBands>(device));
  recipe.products.push_back(
      std::make_unique<DepthPyramid>(device, search == Search::none ? PyramidKind::hsm : pyramid_of(search)));
  recipe.products.push_back(std::make_unique<LevelMaps>(device, push.budget > 0 ? 1 : push.level,
                                                        push.budget > 0 ? gpu::kCoarsestLevel : push.level));
  recipe.products.push_back(std::make_unique<WorkCounts>(device, std::vector<std::string>{"occludersAsked"}));
  recipe.push_words = sizeof(push) / sizeof(std::uint32_t);
  recipe.push = [push](const visibility::Light&) { return push_words(push); };
  return subsampled(device, make_map_method(device, std::move(recipe), options), parsed, options);
}

}  // namespace penumbra::maps
