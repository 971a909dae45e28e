// SPDX-License-Identifier: Apache-2.0
// Computes soft shadows from prefiltered moments: windows as in Fernando 2005, their statistics by Donnelly and
// Lauritzen 2006 (vsm), Lauritzen and McCool 2008 (lvsm, evsm), Annen et al. 2007 and 2008 (csm, esm), and the mean
// blocker by Yang et al. 2010 or, with csm, by Annen et al. 2008. Windows whose mean is behind the receiver are cut
// (Yang et al. 2010). docs/vssm.md lists the departures and their reasons.

#include "maps/filters/methods.hpp"

#include "maps/filters/vssm.comp.spv.hpp"
#include "maps/filters/vssm.shared.h"
#include "maps/filters/vssm_fitted.comp.spv.hpp"
#include "maps/host/map_fit.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/filters/horizon.hpp"
#include "maps/filters/repairs.hpp"
#include "maps/products/depth_pyramid.hpp"
#include "maps/products/light_shape.hpp"
#include "maps/products/map_frame.hpp"
#include "maps/products/nearest_caster.hpp"
#include "maps/products/prefilter.hpp"
#include "maps/products/shadow_depths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace penumbra::maps {
namespace {

enum class Moments : std::uint8_t { vsm, lvsm, evsm, csm, esm };

constexpr visibility::ChoiceOption kMoments{"moments",
                                            {{"vsm", Moments::vsm},
                                             {"lvsm", Moments::lvsm},
                                             {"evsm", Moments::evsm},
                                             {"csm", Moments::csm},
                                             {"esm", Moments::esm}},
                                            Moments::vsm,
                                            "representation of a window's depths: mean and variance; the same in "
                                            "layers, or of exponentials; a Fourier series; or one exponential"};
constexpr visibility::ChoiceOption kFilter{
    "filter",
    {{"sat", PrefilterKind::table}, {"mip", PrefilterKind::pyramid}, {"n-buffer", PrefilterKind::windows}},
    PrefilterKind::table,
    "table from which means over windows are read: summed areas in integers, mip levels, overlapping squares"};
constexpr visibility::IntegerOption kLayers{"layers", 1, 16, 4, "lvsm: layers of equal height"};
constexpr visibility::IntegerOption kTerms{"terms", 1, 16, 16, "csm: terms of the series"};
constexpr visibility::RealOption kOffset{"offset", 0, 8, 1,
                                         "csm: number of lobes by which the step is shifted, so that points level with "
                                         "a receiver are lit; 1: shifted to the series' first maximum"};
constexpr visibility::RealOption kDamping{"damping", 0, 16, 1,
                                          "csm: coefficient k of n is multiplied by exp(-damping (k/n)^2)"};
constexpr visibility::RealOption kScale{
    "scale", 1, 16, 1,
    "csm: the search finds no blocker where the series is 1 / scale; with window V is scale times the series"};
constexpr visibility::RealOption kExponent{
    "exponent", 1, 80, 80,
    "esm: decay of the exponential over the scene's depth; evsm, which squares the exponential: twice the decay"};
constexpr auto kFallback =
    visibility::flag_option("fallback", true, "esm: compares texel by texel where the exponential exceeds 1");
enum class Classifier : std::uint8_t { mean, farthest };
constexpr visibility::ChoiceOption kClassifier{"classifier",
                                               {{"mean", Classifier::mean}, {"farthest", Classifier::farthest}},
                                               Classifier::mean,
                                               "esm: condition for comparing texels one by one: the exponential "
                                               "exceeds 1, or a window may hold a texel behind the receiver"};
constexpr visibility::RealOption kLeak{"leak", 0, 0.99, 0,
                                       "limit of V below which pixels are black; V above is stretched over 0 … 1"};
enum class LeakCut : std::uint8_t { linear, smooth };
constexpr visibility::ChoiceOption kLeakCut{"leakCut",
                                            {{"linear", LeakCut::linear}, {"smoothstep", LeakCut::smooth}},
                                            LeakCut::linear,
                                            "function that stretches V above leak"};
enum class Subdivision : std::uint8_t { automatic, uniform, adaptive, none };
constexpr visibility::ChoiceOption kSubdivision{
    "subdivision",
    {{"auto", Subdivision::automatic},
     {"uniform", Subdivision::uniform},
     {"adaptive", Subdivision::adaptive},
     {"none", Subdivision::none}},
    Subdivision::automatic,
    "vsm, lvsm, evsm: windows are cut into the smallest parts, only where their mean is behind the receiver, or never; "
    "auto: uniform for vsm and lvsm, none for evsm and with the option window"};
constexpr visibility::IntegerOption kCuts{"cuts", 1, 4, 3, "largest number of times that a window is cut in four"};
constexpr visibility::IntegerOption kFixedWindow{
    "window", 0, 64, 0,
    "side in texels of a fixed filter window, as in pcf, for any light; 0: the light's size decides"};
constexpr auto kSlope = visibility::flag_option(
    "slope", false,
    "vsm, lvsm: adds the variance of depth within a texel, from the surface's slope, to each texel's square");

/// Returns a warning if maps are smaller than the default because this device cannot filter maps of the default size.
std::optional<std::string> vssm_warning(const visibility::MethodOptions& options,
                                        const std::map<std::string, std::uint64_t>& counters) {
  if (!counters.contains(kReducedMaps)) return std::nullopt;
  return fmt::format(
      "vssm: maps have {0} texels a side in place of the default of {1}, because the device's buffers cannot hold the "
      "means of larger maps; take filter=sat or fewer terms for {1}, or size={0}",
      options.at(kMapSize.name()), kMapSize.otherwise);
}

/// Return the number of maps of a fit on one side of a light: with a window, and at most, with a hemicube.
std::uint32_t fewest_faces(const ViewFit& fit) {
  if (fit.fit == Fit::tiles) return fit.tiles;
  return fit.projection == Projection::cube || fit.fit == Fit::faces ? 5 : fit.slices();
}
std::uint32_t most_faces(const ViewFit& fit) {
  return fit.fit == Fit::tiles ? std::max(fit.tiles, 5U) : 5 * fit.slices();
}

visibility::MeshVerdict vssm_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("one map, one mean height for all casters that shade a pixel, and a bound in place of a count",
                        mesh);
}

}  // namespace

visibility::MethodDescription vssm_description() {
  visibility::MethodDescription description{
      .name = "vssm",
      .family = visibility::Family::image,
      .paper = "Yang et al. 2010; Annen et al. 2008",
      .output = visibility::Output::scalar,
      .exact_for =
          "nothing; in the limit of large maps, scenes in which all blockers lie in one plane and all receivers in "
          "another, both parallel to a rectangle light",
      .lights = visibility::kPlanarLights,
      .textures = false,
      .options = compared_map_option_descriptions(),
      .verdict_on = vssm_verdict,
      .repairs = vssm_repairs,
      .warning = vssm_warning};
  for (const auto& option :
       {kMoments.description(), kFilter.description(), kSubdivision.description(), kCuts.description(),
        kFixedWindow.description(), kLayers.description(), kTerms.description(), kOffset.description(),
        kDamping.description(), kScale.description(), kExponent.description(), kFallback.description(),
        kClassifier.description(), kLeak.description(), kLeakCut.description(), kSlope.description()}) {
    description.options.push_back(option);
  }
  std::ranges::copy(view_fit_descriptions(), std::back_inserter(description.options));
  return description;
}

namespace {

/// Returns the functions of depth stored for each texel, in the order used by vssm.comp.
std::vector<PrefilterFunction> functions(Moments moments, std::uint32_t count, float exponent, float offset) {
  std::vector<PrefilterFunction> functions;
  const PrefilterFunction height{};
  // Total number of digits that leaves 16 binary digits where an exponential is least, exp(−c). (A float has 24.)
  const auto digits = [&](double c) { return static_cast<std::uint32_t>(std::ceil(c * std::numbers::log2e)) + 16; };
  switch (moments) {
    case Moments::vsm:
    case Moments::lvsm:
      for (std::uint32_t i = 0; i < count; ++i) {
        for (const std::uint32_t power : {gpu::kPlain, gpu::kSquared}) {
          functions.push_back(
              {.kind = gpu::kLayer, .power = power, .a = static_cast<float>(count), .b = static_cast<float>(i)});
        }
      }
      if (count > 1) functions.push_back(height);
      break;
    case Moments::evsm:
      for (const std::uint32_t kind : {gpu::kRising, gpu::kFalling}) {
        for (const std::uint32_t power : {gpu::kPlain, gpu::kSquared}) {
          const double steepest = power == gpu::kSquared ? 2.0 * exponent : exponent;
          functions.push_back({.kind = kind, .power = power, .a = exponent, .digits = digits(steepest)});
        }
      }
      functions.push_back(height);
      break;
    case Moments::csm:
      for (std::uint32_t k = 0; k < count; ++k) {
        const auto step = static_cast<float>((2 * k + 1) * std::numbers::pi * gpu::fourier_span(count, offset));
        for (const std::uint32_t power : {gpu::kPlain, gpu::kTimesHeight}) {
          for (const std::uint32_t kind : {gpu::kSine, gpu::kCosine}) {
            // With 12 digits, each function needs one table at 1024 texels a side; the truncation error of the series
            // is 1 / (2 · 16 · π) in any case.
            functions.push_back({.kind = kind, .power = power, .a = step, .digits = 12});
          }
        }
      }
      functions.push_back(height);
      break;
    case Moments::esm:
      functions.push_back({.kind = gpu::kRising, .a = exponent, .digits = digits(exponent)});
      functions.push_back(height);
      break;
  }
  return functions;
}

}  // namespace

std::unique_ptr<visibility::Method> make_vssm(const render::Device& device, const visibility::MethodOptions& options) {
  const visibility::ParsedOptions parsed = visibility::parse_options(vssm_description(), options);
  const Moments moments = parsed[kMoments];
  std::uint32_t model = gpu::kVariance;
  gpu::VssmPush push{.count = 1,
                     .exponent = static_cast<float>(parsed[kExponent]),
                     .scale = static_cast<float>(parsed[kScale]),
                     .leak = static_cast<float>(parsed[kLeak]),
                     .fallback = parsed[kFallback] ? 1U : 0U,
                     .horizon_samples = kHorizonSamples};
  if (moments == Moments::lvsm) push.count = parsed[kLayers];
  if (moments == Moments::csm) {
    model = gpu::kFourier;
    push.count = parsed[kTerms];
  }
  if (moments == Moments::esm) model = gpu::kExponential;
  if (moments == Moments::evsm) {
    model = gpu::kExpVariance;
    push.exponent /= 2;
  }
  // Windows are cut where a bound of 1 gives no information; a series and an exponential have no bound.
  Subdivision subdivision = parsed[kSubdivision];
  if (subdivision == Subdivision::automatic) {
    const bool cuts_windows = model == gpu::kVariance && parsed[kFixedWindow] == 0;
    subdivision = cuts_windows ? Subdivision::uniform : Subdivision::none;
  }
  const bool bounds = model == gpu::kVariance || model == gpu::kExpVariance;
  const std::uint32_t cuts = bounds && subdivision != Subdivision::none ? parsed[kCuts] : 0;
  // Windows on warped faces are cut for any moments. A series has up to 65 means a part: with three cuts, its loops
  // would have more than the 65,535 iterations after which some drivers for processors end loops.
  const std::uint32_t image_cuts = moments == Moments::csm ? std::min(parsed[kCuts], 2U) : parsed[kCuts];
  const auto offset = static_cast<float>(parsed[kOffset]);
  const std::uint32_t window = parsed[kFixedWindow];
  MapRecipe recipe{.description = vssm_description(),
                   .look_up_name = "vssm look-up",
                   .look_up = shaders::kVssmComp,
                   .fitted_look_up = shaders::kVssmFittedComp,
                   .constants = {model, cuts, subdivision == Subdivision::adaptive ? gpu::kAdaptive : gpu::kUniform,
                                 window, std::bit_cast<std::uint32_t>(offset),
                                 std::bit_cast<std::uint32_t>(static_cast<float>(parsed[kDamping])),
                                 parsed[kLeakCut] == LeakCut::smooth ? 1U : 0U,
                                 parsed[kClassifier] == Classifier::farthest ? 1U : 0U, image_cuts}};
  // With an exponential, no bias is subtracted from a receiver's height.
  recipe.products.push_back(
      std::make_unique<ShadowDepths>(device, parsed[kDepth], moments == Moments::esm ? 0 : parsed[kBias]));
  auto nearest = std::make_unique<NearestCaster>(device);
  auto frame = std::make_unique<MapFrame>(device);
  PrefilterOptions means{.kind = parsed[kFilter],
                         .functions = functions(moments, push.count, push.exponent, offset),
                         .slope = parsed[kSlope]};
  std::uint32_t size = parsed[kMapSize];
  if (!parsed.given(kMapSize)) {
    // The number of maps depends on the light: if the means of one window do not fit, the size allows for a hemicube.
    const ViewFit fit = view_fit(recipe.description.options, parsed);
    const std::uint64_t most_bytes = device.limits().max_storage_buffer_range;
    if (size_that_fits(means, size, fewest_faces(fit), most_bytes) != size) {
      size = size_that_fits(means, size, most_faces(fit), most_bytes);
      means.is_reduced = true;
      recipe.changed_defaults = {{kMapSize.name(), fmt::format("{}", size)}};
    }
  }
  auto prefilter = std::make_unique<Prefilter>(device, std::move(means),
                                               Prefilter::Sources{.nearest = nearest.get(), .frame = frame.get()});
  recipe.products.push_back(std::move(nearest));
  recipe.products.push_back(std::move(frame));
  recipe.products.push_back(std::move(prefilter));
  recipe.products.push_back(
      std::make_unique<LightPattern>(device, std::initializer_list<std::uint32_t>{kHorizonSamples}));
  recipe.products.push_back(std::make_unique<DepthPyramid>(device, PyramidKind::hsm));
  // Extent of the blocker search: see pcss. With a fixed filter width: see pcf.
  const std::uint32_t taps_beside = window / 2;  // rounded down: the middle texel does not count
  const double beside = 2 * kWidestTangent * taps_beside / size;
  recipe.beside = [window, beside](const visibility::Light& light, const LightBasis& basis) {
    return window != 0 ? glm::dvec2(beside) : half_extent(light, basis) / half_width(light);
  };
  recipe.beside_texels = taps_beside;
  recipe.push_words = sizeof(gpu::VssmPush) / sizeof(std::uint32_t);
  recipe.push = [push](const visibility::Light& /*light*/) { return push_words(push); };
  visibility::MethodOptions used = options;
  used.insert(recipe.changed_defaults.begin(), recipe.changed_defaults.end());
  return make_map_method(device, std::move(recipe), used);
}

}  // namespace penumbra::maps
