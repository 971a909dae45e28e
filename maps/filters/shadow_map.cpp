// SPDX-License-Identifier: Apache-2.0
// Computes the hard shadow of the light's centre: Williams 1978, "Casting curved shadows on curved surfaces".
// Departures: the receiver's plane is compared at the texel's centre in place of a constant bias (taps.glsl), and up to
// five faces replace one perspective image (map_fit.cpp).

#include "maps/filters/methods.hpp"
#include "maps/filters/history.hpp"

#include "base/error.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/filters/repairs.hpp"
#include "maps/filters/shadow_map.comp.spv.hpp"
#include "maps/filters/shadow_map_fitted.comp.spv.hpp"
#include "maps/filters/shadow_map_ids.comp.spv.hpp"
#include "maps/products/nearest_ids.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

namespace penumbra::maps {
namespace {

enum class HardTest : std::uint8_t { depth, plane, object };

constexpr visibility::ChoiceOption kHardTest{
    "test",
    {{"depth", HardTest::depth}, {"id", HardTest::plane}, {"object", HardTest::object}},
    HardTest::depth,
    "test of visibility: by the depth of a texel's surface, or by the plane or object of this surface, which must be "
    "the receiver's own (then no bias is needed)"};

constexpr visibility::IntegerOption kHistory{
    "history", 1, 1024, 1,
    "number of frames of a still camera, each with a map whose texels are displaced, mixed by confidence; 1: one map"};

constexpr auto kReproject =
    visibility::flag_option("reproject", false,
                            "in a sequence: mixes V with V of the previous frame where that frame shows the same "
                            "surface; the first frame of a run has no previous frame");

visibility::MeshVerdict shadow_map_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("a hard shadow of the light's centre, its edges off by up to half a texel", mesh);
}

}  // namespace

visibility::MethodDescription shadow_map_description() {
  visibility::MethodDescription description{
      .name = "shadow-map",
      .family = visibility::Family::image,
      .paper = "Williams 1978",
      .output = visibility::Output::scalar,
      .exact_for = "nothing; in the limit of large maps the hard shadow of the light's centre",
      .lights = visibility::kPlanarLights,
      .textures = false,
      .options = compared_map_option_descriptions(),
      .verdict_on = shadow_map_verdict,
      .repairs = filter_repairs};
  description.options.push_back(kHardTest.description());
  description.options.push_back(kHistory.description());
  description.options.push_back(kReproject.description());
  for (const auto& option : {kOffsetFactor.description(), kOffsetUnits.description()}) {
    description.options.push_back(option);
  }
  std::ranges::copy(view_fit_descriptions(), std::back_inserter(description.options));
  return description;
}

std::unique_ptr<visibility::Method> make_shadow_map(const render::Device& device,
                                                    const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = shadow_map_description(),
                   .look_up_name = "shadow map look-up",
                   .look_up = shaders::kShadowMapComp,
                   .fitted_look_up = shaders::kShadowMapFittedComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  if (const HardTest test = parsed[kHardTest]; test != HardTest::depth) {
    if (view_fit(recipe.description.options, parsed).has_faces()) {
      throw UsageError(
          "method shadow-map: test={} supports only windows and cubes; take projection=window or cube with "
          "fit=receivers, or fit=view",
          kHardTest.name_of(test));
    }
    recipe.look_up = shaders::kShadowMapIdsComp;
    recipe.constants = {test == HardTest::object ? 1U : 0U};
    recipe.products.push_back(std::make_unique<NearestIds>(device, parsed[kRasteriser],
                                                           test == HardTest::object ? IdsOf::objects : IdsOf::planes));
  }
  const HistoryOptions history{parsed[kHistory], parsed[kMapSize], parsed[kReproject]};
  if (history.frames == 1 && !history.reproject) return make_map_method(device, std::move(recipe), options);
  if (const ViewFit fit = view_fit(recipe.description.options, parsed); fit.fit != Fit::receivers || fit.has_faces()) {
    throw UsageError(
        "method shadow-map: history={} and reproject=on move windows of all receivers; take fit=receivers and "
        "projection=window or cube",
        history.frames);
  }
  auto jitter = std::make_unique<glm::dvec2>(0);
  recipe.jitter = jitter.get();
  return with_history(make_map_method(device, std::move(recipe), options), std::move(jitter), history);
}

}  // namespace penumbra::maps
