// SPDX-License-Identifier: Apache-2.0
// Looks up layered attenuation maps: Agrawala, Ramamoorthi, Heirich and Moll, "Efficient image-based methods for
// rendering soft shadows" (SIGGRAPH 2000), as described in the course notes of Eisemann et al. (2009, section 5.2.4).
// Departures: a texel is warped with its extent (layered_warp.comp), a receiver not found in its own texel is searched
// for in the eight texels around (option neighbours), its plane is compared at the texel's centre (taps.glsl), and
// receivers below the horizon are dark.

#include "maps/sampling/methods.hpp"

#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/sampling/repairs.hpp"
#include "maps/products/lists/layered_depth.hpp"
#include "maps/sampling/layered_attenuation.comp.spv.hpp"
#include "maps/sampling/layered_attenuation.shared.h"

#include <algorithm>
#include <utility>

namespace penumbra::maps {
namespace {

constexpr visibility::RealOption kSameDepth{"epsilon", 0, 1, 0.02,
                                            "largest relative difference of depths that count as one surface"};
constexpr visibility::ChoiceOption kNeighbours = visibility::flag_option(
    "neighbours", true,
    "also searches the eight texels around a receiver's own if the receiver is not in its own texel");
constexpr visibility::IntegerOption kLayeredSize = map_size(256);

/// Smallest useful epsilon: depths in maps, and of planes, are off by at most sixteen roundings to 24 binary digits.
constexpr double kDepthRounding = 0x1p-20;

visibility::MeshVerdict layered_attenuation_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps(
      "light samples counted on the surfaces that they see, along the rays through texels; receivers elsewhere are off "
      "by up to a texel",
      mesh);
}

}  // namespace

visibility::MethodDescription layered_attenuation_description() {
  visibility::MethodDescription description{
      .name = "layered-attenuation",
      .family = visibility::Family::image,
      .paper = "Agrawala et al. 2000",
      .output = visibility::Output::scalar,
      .exact_for = "nothing; in the limit of large maps and small epsilon the share of light samples that are visible",
      .lights = visibility::kPlanarLights,
      .on_request = true,
      .shares_of_samples = true,
      .options = map_option_descriptions(kLayeredSize),
      .verdict_on = layered_attenuation_verdict,
      .repairs = sampling_repairs};
  description.options.push_back(kSameDepth.description());
  description.options.push_back(kNeighbours.description());
  return description;
}

std::unique_ptr<visibility::Method> make_layered_attenuation(const render::Device& device,
                                                             const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = layered_attenuation_description(),
                   .look_up_name = "layered-attenuation look-up",
                   .look_up = shaders::kLayeredAttenuationComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  const double epsilon = std::max(parsed[kSameDepth], kDepthRounding);
  const bool neighbours = parsed[kNeighbours];
  auto layers = std::make_unique<LayeredDepth>(device, epsilon, parsed[kRasteriser]);
  recipe.push_words = sizeof(gpu::AttenuationPush) / sizeof(std::uint32_t);
  recipe.push = [epsilon, neighbours, &made = *layers](const visibility::Light& light) {
    return push_words(gpu::AttenuationPush{.sample_count = light.sample_count(),
                                           .neighbours = neighbours ? 1u : 0u,
                                           .epsilon = static_cast<float>(epsilon),
                                           .total = static_cast<float>(made.total_weight()),
                                           .layers = made.layers()});
  };
  recipe.products.push_back(std::move(layers));
  recipe.products.push_back(std::make_unique<SamplePoints>(device));
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
