// SPDX-License-Identifier: Apache-2.0
// Looks up penumbra deep shadow maps: St-Amour, Paquette and Poulin, "Soft shadows from extended light sources with
// penumbra deep shadow maps" (Graphics Interface 2005), as described in the course notes of Eisemann et al. (2009,
// section 5.2.4). Departures: V(depth) is kept as constant pieces (V jumps at every event, so that lines would violate
// the bound), V = 1 and V = 0 are kept exactly, the receiver's plane is compared at the texel's centre (taps.glsl), and
// receivers below the horizon are dark.

#include "maps/sampling/methods.hpp"

#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/sampling/repairs.hpp"
#include "maps/products/lists/penumbra_events.hpp"
#include "maps/sampling/deep_penumbra.comp.spv.hpp"
#include "maps/sampling/deep_penumbra.shared.h"

#include <utility>

namespace penumbra::maps {
namespace {

constexpr visibility::RealOption kBound{"bound", 0, 0.5, 0.01,
                                        "largest error of V that is accepted to save steps of depth"};
constexpr visibility::IntegerOption kDeepSize = map_size(256);

visibility::MeshVerdict deep_penumbra_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps(
      "V of the light samples along the rays through one map's texels; receivers elsewhere are off by up to a texel",
      mesh);
}

}  // namespace

visibility::MethodDescription deep_penumbra_description() {
  visibility::MethodDescription description{
      .name = "deep-penumbra",
      .family = visibility::Family::image,
      .paper = "St-Amour et al. 2005",
      .output = visibility::Output::scalar,
      .exact_for = "nothing; in the limit of large maps and bound 0 the share of light samples that are visible",
      .lights = visibility::kPlanarLights,
      .on_request = true,
      .shares_of_samples = true,
      .options = map_option_descriptions(kDeepSize),
      .verdict_on = deep_penumbra_verdict,
      .repairs = sampling_repairs};
  description.options.push_back(kBound.description());
  return description;
}

std::unique_ptr<visibility::Method> make_deep_penumbra(const render::Device& device,
                                                       const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = deep_penumbra_description(),
                   .look_up_name = "deep-penumbra look-up",
                   .look_up = shaders::kDeepPenumbraComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  recipe.products.push_back(std::make_unique<PenumbraEvents>(device, parsed[kBound]));
  recipe.products.push_back(std::make_unique<SamplePoints>(device));
  recipe.push_words = sizeof(gpu::DeepPenumbraPush) / sizeof(std::uint32_t);
  recipe.push = [](const visibility::Light& light) { return push_words(gpu::DeepPenumbraPush{light.sample_count()}); };
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
