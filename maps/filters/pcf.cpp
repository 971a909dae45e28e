// SPDX-License-Identifier: Apache-2.0
// Computes percentage-closer filtering: Reeves, Salesin, Cook 1987, "Rendering antialiased shadows with depth maps";
// the window and its weights as in Eisemann et al. 2009, section 4.1.2. Departures: each texel is compared with the
// receiver's plane (receiverPlane=off: with the receiver's depth, as published), and a window in a hemicube continues
// on the next face.

#include "maps/filters/methods.hpp"

#include "base/error.hpp"
#include "maps/filters/pcf.comp.spv.hpp"
#include "maps/filters/pcf_fitted.comp.spv.hpp"
#include "maps/filters/pcf_ids.comp.spv.hpp"
#include "maps/filters/pcf.shared.h"
#include "maps/host/map_fit.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/filters/repairs.hpp"
#include "maps/products/nearest_ids.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

namespace penumbra::maps {
namespace {

constexpr visibility::IntegerOption kWindow{"window", 1, 64, 7, "texels on a side of the window that is averaged"};

constexpr visibility::ChoiceOption kWeights{
    "weights",
    {{"equal", gpu::kEqual}, {"gaussian", gpu::kGaussian}, {"bilinear", gpu::kBilinear}},
    gpu::kEqual,
    "weights of texels: equal; a Gaussian whose deviation is a quarter of the window; or each texel's share of a "
    "window that is centred on the receiver (window=1: the bilinear test of four texels)"};
constexpr visibility::ChoiceOption kTest{
    "test",
    {{"depth", gpu::kByDepth}, {"object", gpu::kByObject}, {"mean", gpu::kByMeanDepth}},
    gpu::kByDepth,
    "test of a receiver: against each texel's depth; the same, but no object shades itself; or against the window's "
    "mean depth, by a smooth test"};
constexpr visibility::ChoiceOption kKeep{
    "keep",
    {{"0", 0U}, {"2", 2U}, {"3", 3U}},
    0U,
    "2: compare only the texels of the window's least and greatest depth; 3: also the texel whose depth is nearest to "
    "the middle between these; 0: compare all texels"};
constexpr visibility::RealOption kSoftness{
    "softness", 0.0001, 4, 0.1,
    "test=mean: distance behind the mean depth at which the receiver is dark, as a fraction of the receiver's depth"};
constexpr visibility::IntegerOption kTaps{
    "taps", 0, 256, 0,
    "number of texels of the window that are compared, in a pattern that is rotated at every receiver; 0: all of them"};
constexpr visibility::IntegerOption kStages{"stages", 1, 2, 1,
                                            "2: the outermost quarter of the taps decides alone if these taps agree"};

visibility::MeshVerdict pcf_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("a hard shadow of the light's centre, blurred by a window of the same size for any light",
                        mesh);
}

/// Throws UsageError for options that exclude one another.
void refuse_together(const visibility::MethodDescription& method, const visibility::ParsedOptions& options,
                     const gpu::PcfPush& push) {
  if (push.weights == gpu::kBilinear && push.taps != 0) {
    throw UsageError(
        "method pcf: weights=bilinear weights parts of texels, but taps={} reads whole texels; take taps=0", push.taps);
  }
  if (push.keep != 0 && (push.taps != 0 || push.weights != gpu::kEqual || push.test == gpu::kByMeanDepth)) {
    throw UsageError(
        "method pcf: keep={} chooses among all texels of a window, with equal weights; take taps=0, weights=equal and "
        "test=depth or object",
        push.keep);
  }
  if (push.test == gpu::kByMeanDepth && (push.taps != 0 || push.weights == gpu::kBilinear)) {
    throw UsageError(
        "method pcf: test=mean takes the mean over all texels of a window; take taps=0 and weights=equal "
        "or gaussian");
  }
  if (push.test == gpu::kByObject && view_fit(method.options, options).has_faces()) {
    throw UsageError(
        "method pcf: test=object supports only windows and cubes; take projection=window or cube with fit=receivers, "
        "or fit=view");
  }
}

}  // namespace

visibility::MethodDescription pcf_description() {
  visibility::MethodDescription description{
      .name = "pcf",
      .family = visibility::Family::image,
      .paper = "Reeves, Salesin and Cook 1987",
      .output = visibility::Output::scalar,
      .exact_for = "nothing; in the limit of large maps the hard shadow of the light's centre",
      .lights = visibility::kPlanarLights,
      .textures = false,
      .options = compared_map_option_descriptions(),
      .verdict_on = pcf_verdict,
      .repairs = pcf_repairs};
  for (const auto& option : {kWindow.description(), kWeights.description(), kTaps.description(), kStages.description(),
                             kTest.description(), kKeep.description(), kSoftness.description()}) {
    description.options.push_back(option);
  }
  for (const auto& option : {kOffsetFactor.description(), kOffsetUnits.description()}) {
    description.options.push_back(option);
  }
  std::ranges::copy(view_fit_descriptions(), std::back_inserter(description.options));
  return description;
}

std::unique_ptr<visibility::Method> make_pcf(const render::Device& device, const visibility::MethodOptions& options) {
  MapRecipe recipe{.description = pcf_description(),
                   .look_up_name = "pcf look-up",
                   .look_up = shaders::kPcfComp,
                   .fitted_look_up = shaders::kPcfFittedComp};
  const visibility::ParsedOptions parsed = visibility::parse_options(recipe.description, options);
  const gpu::PcfPush push{parsed[kWindow],
                          parsed[kWeights],
                          parsed[kTaps],
                          parsed[kStages],
                          parsed[kTest],
                          parsed[kKeep],
                          static_cast<float>(parsed[kSoftness])};
  refuse_together(recipe.description, parsed, push);
  if (push.test == gpu::kByObject) {
    recipe.look_up = shaders::kPcfIdsComp;
    recipe.products.push_back(std::make_unique<NearestIds>(device, parsed[kRasteriser], IdsOf::objects));
  }
  // The window extends half its texels to either side of a receiver's direction. The width of a texel depends on the
  // extent of the window of receivers, which is at most ±kWidestTangent.
  const std::uint32_t reach = push.window / 2 + (push.weights == gpu::kBilinear ? 1 : 0);  // in whole texels
  const double beside = 2 * kWidestTangent * reach / parsed[kMapSize];
  recipe.beside = [beside](const visibility::Light& /*light*/, const LightBasis& /*basis*/) {
    return glm::dvec2(beside);
  };
  recipe.beside_texels = reach;
  recipe.push_words = sizeof(gpu::PcfPush) / sizeof(std::uint32_t);
  recipe.push = [push](const visibility::Light& /*light*/) { return push_words(push); };
  return make_map_method(device, std::move(recipe), options);
}

}  // namespace penumbra::maps
