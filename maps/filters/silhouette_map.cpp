// SPDX-License-Identifier: Apache-2.0
// Computes hard shadows with silhouette points: Sen, Cammarano, Hanrahan 2003, "Shadow silhouette maps"; Sen 2004.
// Departures: those of silhouette_points.cpp, and the receiver's plane is compared at each texel's centre
// (receiverPlane=off: the receiver's own depth, as published).

#include "maps/filters/methods.hpp"

#include "maps/filters/repairs.hpp"
#include "maps/filters/silhouette_map.comp.spv.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/products/silhouette_points.hpp"

#include <memory>
#include <utility>

namespace penumbra::maps {
namespace {

visibility::MeshVerdict silhouette_map_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps(
      "a hard shadow of the light's centre with straight edges, wherever no two edges pass through one texel", mesh);
}

}  // namespace

visibility::MethodDescription silhouette_map_description() {
  return {.name = "silhouette-map",
          .family = visibility::Family::image,
          .paper = "Sen, Cammarano and Hanrahan 2003",
          .output = visibility::Output::scalar,
          .exact_for =
              "nothing; the hard shadow of the light's centre wherever a single straight edge passes through a texel",
          .lights = visibility::kPlanarLights,
          .textures = false,
          .on_request = true,
          .options = compared_map_option_descriptions(),
          .verdict_on = silhouette_map_verdict,
          .repairs = filter_repairs};
}

std::unique_ptr<visibility::Method> make_silhouette_map(const render::Device& device,
                                                        const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = silhouette_map_description(),
                   .look_up_name = "silhouette map look-up",
                   .look_up = shaders::kSilhouetteMapComp};
  recipe.products.push_back(std::make_unique<SilhouettePoints>(device));
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
