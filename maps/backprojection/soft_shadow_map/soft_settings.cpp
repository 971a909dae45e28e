// SPDX-License-Identifier: Apache-2.0
// Options of soft-shadow-map, and its description.

#include "maps/backprojection/soft_shadow_map/soft_settings.hpp"

#include "base/error.hpp"
#include "maps/backprojection/soft_shadow_map/methods.hpp"
#include "maps/host/error_repairs.hpp"
#include "maps/host/map_method.hpp"
#include "maps/host/mesh_verdict.hpp"
#include "maps/host/view_fit.hpp"

#include <algorithm>
#include <iterator>

namespace penumbra::maps {
namespace {

constexpr visibility::IntegerOption kSize{"size", 8, 16384, 128, "texels on a side of the map of occluders"};
constexpr visibility::RealOption kNoBias{
    "bias", 0, 1024, 0, "smallest distance, in the occluders' texels, of an occluder in front of a receiver"};
constexpr visibility::IntegerOption kReceiverSize{"receiverSize", 8, 4096, 256,
                                                  "texels on a side of the map of receivers, which holds V"};
constexpr visibility::ChoiceOption kPasses{
    "passes",
    {{"1", 1u}, {"2", 2u}},
    1u,
    "2: a second pass with the farthest surfaces; the smaller V of both passes counts"};
constexpr visibility::ChoiceOption kPatches{"patches",
                                            {{"top", SoftPatches::top}, {"bottom", SoftPatches::bottom}},
                                            SoftPatches::top,
                                            "surfaces in one pass's texels: nearest to the light, or farthest"};
constexpr visibility::ChoiceOption kPrecision{"precision",
                                              {{"fp32", SoftPrecision::fp32}, {"fp16", SoftPrecision::fp16}},
                                              SoftPrecision::fp32,
                                              "fp16: adds in 16-bit floats, as the published blending did"};
constexpr visibility::ChoiceOption kForm{"form",
                                         {{"gather", SoftForm::gather}, {"scatter", SoftForm::scatter}},
                                         SoftForm::gather,
                                         "map that the shader traverses; the sums are the same"};
constexpr visibility::ChoiceOption kFilter{"filter",
                                           {{"linear", SoftFilter::linear}, {"nearest", SoftFilter::nearest}},
                                           SoftFilter::linear,
                                           "interpolation of V from its map"};

constexpr visibility::ChoiceOption kSelf{"self",
                                         {{"none", SoftSelf::none}, {"backproject", SoftSelf::backproject}},
                                         SoftSelf::none,
                                         "V of pixels on occluders, which the paper leaves out: the light above their "
                                         "horizon, or V by backproject with a map of this size"};

visibility::MeshVerdict soft_shadow_map_verdict(const mesh::Diagnosis& mesh) {
  return judge_for_maps("a sum of texels, each projected onto the light; objects do not shade themselves", mesh);
}

visibility::ErrorRepairs repairs(const visibility::MethodDescription& method, const visibility::MethodOptions& given) {
  return map_repairs(
      method, given,
      {.doubled = {"size", "receiverSize"},
       .layers = "passes=2 adds the farthest surfaces; no form of the method has the surfaces in between",
       .fusion = "patches are added, or the smaller V of two passes taken; no form joins them",
       .gaps = "no form of the method fills the gaps between patches",
       .bias = {{"bias", "0"}}});
}

/// Returns a warning if there are pixels on occluders and no other method shades them.
std::optional<std::string> warning(const visibility::MethodOptions& options,
                                   const std::map<std::string, std::uint64_t>& counters) {
  const auto found = counters.find(kPixelsOnOccluders);
  if (found == counters.end() || found->second == 0) return std::nullopt;
  // The options include those of the whole family, which are not declared here.
  const auto self = options.find(kSelf.name());
  if (self != options.end() && self->second != kSelf.name_of(SoftSelf::none)) return std::nullopt;
  return "soft-shadow-map draws no shadows on casters: pixels that show a caster (counter pixelsOnOccluders) see all "
         "of the light above their horizon; method option self=backproject shades them";
}

}  // namespace

visibility::MethodDescription soft_shadow_map_description() {
  visibility::MethodDescription description{
      .name = "soft-shadow-map",
      .family = visibility::Family::image,
      .paper = "Atty et al. 2006",
      .output = visibility::Output::scalar,
      .exact_for =
          "nothing; in the limit of large maps a receiver below occluders that are flat and parallel to the light "
          "and do not overlap",
      .lights = visibility::kPlanarLights,
      .options = map_option_descriptions(kSize, kNoBias),
      .verdict_on = soft_shadow_map_verdict,
      .repairs = repairs,
      .warning = warning};
  for (const visibility::OptionDescription& option :
       {kDepth.description(), kReceiverSize.description(), kPasses.description(), kPatches.description(),
        kPrecision.description(), kForm.description(), kFilter.description(), kSelf.description()}) {
    description.options.push_back(option);
  }
  std::ranges::copy(window_fit_descriptions(), std::back_inserter(description.options));
  return description;
}

SoftSettings soft_settings(const visibility::ParsedOptions& parsed) {
  const SoftSettings settings{.receiver_size = parsed[kReceiverSize],
                              .passes = parsed[kPasses],
                              .patches = parsed[kPatches],
                              .precision = parsed[kPrecision],
                              .form = parsed[kForm],
                              .filter = parsed[kFilter],
                              .self = parsed[kSelf]};
  if (settings.precision == SoftPrecision::fp16 && settings.form == SoftForm::scatter) {
    throw UsageError(
        "method soft-shadow-map: sums of 16-bit floats depend on their order, and scattered ones have no fixed order; "
        "take form=gather, which adds patches in the order of their texels, or precision=fp32");
  }
  if (settings.patches == SoftPatches::bottom && settings.passes > 1) {
    throw UsageError(
        "method soft-shadow-map: patches=bottom selects what a single pass draws, and passes=2 draws the farthest "
        "surfaces anyway; take one of the two");
  }
  if (settings.patches == SoftPatches::bottom && parsed[kDepth] != DepthUse::first) {
    throw UsageError(
        "method soft-shadow-map: patches=bottom draws the farthest surfaces, to which depth= does not apply; take one "
        "of the two");
  }
  return settings;
}

}  // namespace penumbra::maps
