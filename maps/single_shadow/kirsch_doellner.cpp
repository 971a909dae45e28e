// SPDX-License-Identifier: Apache-2.0
// Looks up a map of distances to the border of the hard shadow: Kirsch and Döllner 2003, "Real-time soft shadows using
// a single light sample", as described in the course notes of Eisemann et al. (2009, section 5.2.1). Departures:
// distances are Euclidean, computed in two passes; all casters except the ground count as occluders (as in convolution;
// the paper takes occluders and receivers as input); the extent of light into the shadow follows from the light's
// radius.

#include "maps/single_shadow/methods.hpp"

#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/single_shadow/kirsch_doellner.comp.spv.hpp"
#include "maps/single_shadow/kirsch_doellner.shared.h"
#include "maps/single_shadow/options.hpp"
#include "maps/single_shadow/descriptions.hpp"
#include "maps/single_shadow/width_map.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace penumbra::maps {
namespace {

visibility::MeshVerdict kirsch_doellner_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("the hard shadow of the light's centre, with penumbrae inside of it only", mesh);
}

/// Returns a warning if the width map cannot separate occluders from receivers: shadows then have no penumbra.
std::optional<std::string> kirsch_doellner_warning(const visibility::MethodOptions& /*options*/,
                                                   const std::map<std::string, std::uint64_t>& counters) {
  const auto count = [&](const char* name) {
    const auto found = counters.find(name);
    return found == counters.end() ? 1U : found->second;
  };
  if (count("occludingTriangles") == 0)
    return "kirsch-doellner: only the ground (the largest object) casts shadow, so its shadows are hard";
  if (count("groundObjects") == 0)
    return "kirsch-doellner: some receiver casts no shadow, so all casters count as occluders: shadows are hard where "
           "one caster lies behind another";
  return std::nullopt;
}

}  // namespace

visibility::MethodDescription kirsch_doellner_description() {
  visibility::MethodDescription description =
      single_shadow_description({.name = "kirsch-doellner",
                                 .paper = "Kirsch and Döllner 2003",
                                 .exact_for = "nothing; all is lit outside of the hard shadow",
                                 .options = compared_map_option_descriptions(),
                                 .verdict_on = kirsch_doellner_verdict,
                                 .repairs = searched_shadow_repairs});
  description.warning = kirsch_doellner_warning;
  for (const auto& option : {kSearchRadius.description(), falloff_option(gpu::kFalloffLinear).description()}) {
    description.options.push_back(option);
  }
  return description;
}

std::unique_ptr<visibility::Method> make_kirsch_doellner(const render::Device& device,
                                                         const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = kirsch_doellner_description(),
                   .look_up_name = "shadow width look-up",
                   .look_up = shaders::kKirschDoellnerComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  recipe.products.push_back(std::make_unique<WidthMap>(device, parsed[kSearchRadius], parsed[kRasteriser]));
  recipe.push_words = sizeof(gpu::KirschDoellnerPush) / sizeof(std::uint32_t);
  recipe.push = [falloff = parsed[falloff_option(gpu::kFalloffLinear)]](const visibility::Light& light) {
    return push_words(gpu::KirschDoellnerPush{falloff, static_cast<float>(half_width(light))});
  };
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
