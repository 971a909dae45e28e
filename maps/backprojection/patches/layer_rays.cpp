// SPDX-License-Identifier: Apache-2.0
// Casts shadow rays through a layered depth image of the light's centre: Lischinski and Rappoport 1998, "Image-based
// rendering for non-diffuse synthetic scenes"; Keating and Max 1999, "Shadow penumbrae for complex objects by
// depth-dependent filtering of multi-layer depth images"; Agrawala et al. 2000 (ray tracing of layers). These rays use
// all information of k layers: no method that projects k layers back onto the light has more. Departures: layers are
// peeled from one view where the papers warp others into one; texels of a receiver's own surface are excluded as in the
// other methods here (host/taps.glsl); walls between neighbours replace the papers' tolerances in depth.

#include "maps/backprojection/patches/methods.hpp"

#include "maps/backprojection/light_table.hpp"
#include "maps/backprojection/patches/layer_rays.comp.spv.hpp"
#include "maps/backprojection/patches/layer_rays.shared.h"
#include "maps/backprojection/patches/light_sample_bands.hpp"
#include "maps/backprojection/patches/repairs.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/products/work_counts.hpp"

#include <string>
#include <utility>
#include <vector>

namespace penumbra::maps {
namespace {

constexpr visibility::IntegerOption kRayLayers{"layers", 1, gpu::kMostLayers, 4,
                                               "number of layers of surfaces that rays meet"};
constexpr visibility::RealOption kGap{
    "gap", 0, 1e6, 8,
    "largest difference in depth, in widths of a texel, up to which a wall joins the surfaces of neighbouring texels"};
constexpr auto kSolid = visibility::flag_option(
    "solid", false,
    "on: the space between an odd layer and the next is solid, as in closed bodies; off: surfaces alone");

visibility::MeshVerdict layer_rays_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("the first layers of surfaces behind each other as the light's centre sees them", mesh);
}

}  // namespace

visibility::MethodDescription layer_rays_description() {
  visibility::MethodDescription description{
      .name = "layer-rays",
      .family = visibility::Family::image,
      .paper = "Keating and Max 1999",
      .output = visibility::Output::mask,
      .exact_for = "nothing; in the limit of large maps every pair whose occluders are in the layers",
      .lights = visibility::kPlanarLights,
      .on_request = true,
      .options = map_option_descriptions(),
      .verdict_on = layer_rays_verdict,
      .repairs = layer_ray_repairs};
  for (const auto& option :
       {kReceiverPlane.description(), kRayLayers.description(), kGap.description(), kSolid.description()}) {
    description.options.push_back(option);
  }
  return description;
}

std::unique_ptr<visibility::Method> make_layer_rays(const render::Device& device,
                                                    const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = layer_rays_description(),
                   .look_up_name = "layer rays look-up",
                   .look_up = shaders::kLayerRaysComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  const gpu::LayerRaysPush push{parsed[kRayLayers], static_cast<float>(parsed[kGap]), parsed[kSolid] ? 1u : 0u};
  recipe.whole_light = true;
  recipe.group_a_receiver = true;
  recipe.layers.count = push.layers;
  recipe.products.push_back(std::make_unique<NearestCaster>(device));
  recipe.products.push_back(std::make_unique<LightTable>(device));
  recipe.products.push_back(std::make_unique<LightSampleBands>(device));
  recipe.products.push_back(std::make_unique<DepthPyramid>(device, PyramidKind::ysm));
  recipe.products.push_back(std::make_unique<WorkCounts>(device, std::vector<std::string>{"texelsPassed"}));
  recipe.push_words = sizeof(push) / sizeof(std::uint32_t);
  recipe.push = [push](const visibility::Light&) { return push_words(push); };
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
